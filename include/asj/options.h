/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_OPTIONS_H
#define ASJ_OPTIONS_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Presets. `default` is what we recommend; `paper` follows "Anisotropic-Scale Junction Detection and Matching for Indoor
 * Images" to the letter wherever the letter can work; `match` makes the detector find what the matcher wants: weaker junctions
 * too, since the matcher tells the false ones. Every difference between them is one field below. */
enum { ASJ_PRESET_DEFAULT = 0, ASJ_PRESET_PAPER = 1, ASJ_PRESET_MATCH = 2 };

enum {
    ASJ_OPTION_NUMBER = 1, /* double */
    ASJ_OPTION_INTEGER = 2,/* int32_t */
    ASJ_OPTION_SWITCH = 3, /* int32_t, 0 or 1; text: "yes", "no", "on", "off", "true", "false", "1", "0" */
    ASJ_OPTION_CHOICE = 4, /* int32_t, index into `choices`; text: the word */
    ASJ_OPTION_RADII = 5   /* uint32_t, bit r set = radius r is in the set; text: "5,7,10,14" or "3-12" */
};

/* One row of an option table. The command line, the bindings and the manual are all made from these rows. A later version may add
 * fields at the end: read rows through the pointers that asj_detect_option() and asj_match_option() return, do not copy them. */
typedef struct asj_option_info {
    const char *key;          /* "minimum_length"; on the command line --minimum-length */
    const char *unit;         /* "px", "deg", "" */
    const char *help;         /* one sentence */
    const char *const *choices; /* ASJ_OPTION_CHOICE: NULL-terminated words; else NULL */
    int32_t type;             /* ASJ_OPTION_... */
    uint32_t offset;          /* of the field in the options struct, in bytes */
    double minimum, maximum;  /* inclusive; radii: the smallest and the largest radius */
    double default_value;     /* preset `default`; radii: the bits */
    double paper_value;       /* preset `paper` */
    double match_value;       /* preset `match` */
    double step;              /* only minimum + a multiple of this is allowed; 0 = everything in the range */
    const char *group;        /* the step in which the option acts: "step 1, gradient". Rows of a group stand together */
    const char *former_key;   /* name until the version before; still taken, with a warning. NULL = none */
    int32_t advanced;         /* 1 = few users need it: --help shows it with --advanced only */
    int32_t reserved;         /* zero */
} asj_option_info;

/* Options of asj_detect(). Fill with asj_detect_options_init(), then change fields or call asj_detect_options_set().
 * Steps are those of the paper's pipeline as src/README.md lists them; detect_options.c holds the same table with ranges.
 * "number of false alarms" (NFA) is the expected number of accidental detections per image of pure noise.
 * In the comments: range; preset default; presets paper and match where they differ from default. */
typedef struct asj_detect_options {
    /* octaves: the whole detector on the image, on its half, on its quarter, .. */
    int32_t octaves;              /* how many at most, from first_octave on, as long as 48 px of either side are left. 1 .. 16;
                                   * default 16; paper 1; match 4 */
    int32_t first_octave;         /* 0 = the image itself, 1 = its half, ..: large photographs may begin there, smaller ones with
                                   * the last octave that they have; -1 = the image upsampled by two, which finds corners with
                                   * branches of few pixels. -1 .. 15; 0 */
    int32_t half_octaves;         /* 1 = the image is looked at half-way between two octaves, too: finds weak and soft corners more
                                   * surely, for half as much time again and 2 bytes for each pixel of the first octave. 0 */
    int32_t independent_octaves;  /* 1 = every octave is a detector of its own and keeps what it finds, though a finer one has
                                   * found the same corner: for the matcher, which takes each corner once. 0; match 1 */
    int32_t colours;              /* 1 = 8-bit colour images are also looked at in two planes of opponent colours, red against green
                                   * and blue against yellow: finds corners between surfaces that hardly differ in luma, in 1.2 to
                                   * 1.7 times the time. These need an NFA of 1, .001 where the noise of colours is smooth as that
                                   * of JPEG is, or epsilon if that is less; where octaves share false alarms all planes do. 0 */
    int32_t three_sizes;          /* 1 = where there may be junctions the image is looked at .84 and 1.19 times as large, too, and
                                   * what two of the three have stays: fewer that come and go with small changes of the image, in
                                   * 1.4 to 1.7 times the time and 16 bytes for each pixel in place of 7. 0 */
    /* step 1: normalised gradient */
    double gradient_epsilon;      /* grey levels (0..255) per pixel added to the local mean of the gradient norm; what is much
                                   * weaker than this is flat. 0.05 .. 16; default 0.4; paper 0.05 */
    int32_t standardise;          /* 1 = give each gradient axis zero mean and unit variance over the image, as the paper does;
                                   * 0 = one fixed scale. default 0; paper 1 */
    /* step 2: local junction field, candidates */
    int32_t field_radius;         /* px: 3, 5, 7 or 9; 7 */
    double sector_width;          /* tau: half-width of a sector's outer arc in pixels. 1 .. 3; 2; paper 2.5 */
    double field_epsilon;         /* a local branch is kept when (sectors of its pixel) x tail <= this. 1e-6 .. 100; 1 */
    double candidate_strength;    /* standard deviations that two local branches of a candidate need. 0 .. 12; 2.4;
                                   * paper 5.15; match 2 */
    int32_t candidate_step;       /* px from one pixel that may be a candidate to the next, along x and along y. 1 .. 2;
                                   * 2; paper 1; match 1 */
    int32_t seeds;                /* ASJ_SEEDS_...: where candidates come from; field; paper segments. With segments the two
                                   * options before this mean nothing, with field the next three */
    double segment_epsilon;       /* NFA allowed for a line segment. 1e-6 .. 1e12; 1e6; paper 1e7 */
    double seed_gap;              /* px between two segments that nearly meet, from where they would. 0 .. 50; 12; paper 10 */
    int32_t seed_radius;          /* px around such a place, and around the ends of such segments. 0 .. 10; 3 */
    /* step 3: isotropic junctions */
    uint32_t isotropic_radii;     /* bit r set = radius r is tested, 3 .. 30; 7,14; paper 3-10 */
    int32_t isotropic_persistence; /* radii of these, one after the other, at which a junction is meaningful; where there are fewer
                                   * radii none is. 1 .. 8; 1; paper 3 */
    int32_t disjoint_sectors;     /* 1 = the sectors of a junction do not overlap: its branches are 2 Delta apart, not Delta.
                                   * 0; paper 1 */
    int32_t max_branches;         /* branches tested together. 2 .. 5; 5 */
    int32_t all_meaningful_branches; /* 1 = a junction has all branches of which two alike would be a meaningful junction;
                                   * 0 = as many as make it most meaningful. 0; paper 1 */
    int32_t isotropic_separation; /* px: of junctions no farther apart the most meaningful one stays; 0 = half its radius.
                                   * 0 .. 15; 2; paper 0 */
    int32_t more_branches_win;    /* 1 = of junctions that near the one with the most branches stays, not the most meaningful one.
                                   * 0 */
    double epsilon;               /* NFA allowed for a junction, and for a branch (steps 3 and 5), in coarse octaves for a branch or
                                   * two that open together. 1e-30 .. 1e6; 1; match 1e4 */
    /* step 4: branch lengths */
    double scan_epsilon;          /* NFA at which a step along a ray still belongs to the branch. 1e-6 .. 1e3; 1; match 10 */
    int32_t scan_start;           /* px: first radius looked at; 0 = the junction's isotropic scale. 0 .. 30; 3; paper 0; match 0 */
    int32_t scan_tolerance;       /* failing steps in a row that a branch survives. 0 .. 8; 1; paper 0 */
    int32_t arc_half_width;       /* px: 2 w + 1 samples across the ray. 1 .. 3; 2 */
    int32_t scan_axial;           /* 1 = scan twice, by direction and by axis, and take the mean length. 1; paper 0 */
    /* step 5: location, orientation and validation */
    double minimum_opening;       /* deg: at least two branches of a junction open by this much, and by at most 180 minus this.
                                   * 0 .. 80; 25; paper 0; match 20 */
    double minimum_length;        /* px of the image, in all octaves: shorter branches are dropped. 0 .. 1000; 0 */
    int32_t refinement;           /* ASJ_REFINE_...: line fits, or the paper's search; line_fit; paper search */
    int32_t ignore_frame;         /* 1 = drop branches that run along the border of the image, within 2.5 px. 1; paper 0 */
    double max_move;              /* px a junction may move while it is located by line fits; with strip_test sharp corners up to
                                   * 6.5. 0.5 .. 10; 2.5; match 5 */
    double merge_angle;           /* deg: of two branches closer than this one stays. 0 .. 60; 15; paper 0 */
    double strip_half_width;      /* px. 0.5 .. 4; 1.5 */
    double strip_length;          /* px from the junction that the strip test looks at. 10 .. 1000; 60 */
    double near_strength;         /* standard deviations that a branch needs in its first 6 px. -10 .. 10; 0;
                                   * paper -10; match -10 */
    double max_tilt;              /* deg: a branch that crosses the edges in its strip at a larger angle is turned to them,
                                   * or counts less; one that slips from each to the next at a smaller one ends where it leaves the
                                   * first. 0 = neither is asked. 0 .. 45; 6; paper 0; match 0 */
    double snap_distance;         /* px of its octave: a branch that ends this close to a junction on its line ends there; if not 0,
                                   * from 4 px in coarse octaves and 8 at corners beyond doubt. 0 .. 30; 2; paper 0; match 8 */
    double end_contrast;          /* an edge ends where it has this share of its own contrast left, or breaks off, unless it goes on
                                   * as strong all along; 0 = where the scan loses it, which depends on noise. 0 .. 0.9; 0.15;
                                   * paper 0; match 0 */
    int32_t strip_test;           /* 1 = a branch is reported only if the strip along it is meaningful at `epsilon`, in coarse
                                   * octaves alone or together with another one; stronger edges beside it are told from it when
                                   * its line is fitted; and two tangents of an arc are no junction. 1; paper 0; match 0 */
    int32_t complete_junctions;   /* 1 = around every junction branches are looked for that its test has missed, mostly edges much
                                   * fainter than its others, up to max_branches; without independent_octaves sharp branches of
                                   * coarse octaves join, too, as soft ones and those with an NFA up to 1e-30 do in any case, beyond
                                   * max_branches. In 1.1 to 1.3 times the time; not with ASJ_REFINE_SEARCH. 0 */
    double reserved[15];          /* zero */
} asj_detect_options;

enum { ASJ_SEEDS_FIELD = 0, ASJ_SEEDS_SEGMENTS = 1 };
enum { ASJ_REFINE_LINE_FIT = 0, ASJ_REFINE_SEARCH = 1 };

/* Fills in the preset `default`. NULL is ignored. */
ASJ_API void asj_detect_options_init(asj_detect_options *options);

/* Fills in a preset (ASJ_PRESET_...). ASJ_ERROR_ARGUMENT: options is NULL; ASJ_ERROR_OPTION: no such preset. */
ASJ_API asj_status asj_detect_options_preset(asj_detect_options *options, int32_t preset);

/* Number of rows of the option table, and one row; NULL outside the range. Static data, any thread. */
ASJ_API size_t asj_detect_option_count(void);
ASJ_API const asj_option_info *asj_detect_option(size_t index);

/* Sets one option by its key ('-' and '_' are the same) from text. The number must be the whole text, in the C locale's
 * form whatever the locale, and in range. A former key (asj_option_info.former_key) is taken too.
 * If message is not NULL, message_size bytes there receive a sentence:
 * ASJ_OK              a warning when the key is a former one, which the next version refuses; else empty
 * ASJ_ERROR_ARGUMENT  a NULL pointer; empty
 * ASJ_ERROR_OPTION    unknown key, not a number, out of range: names key, text and range */
ASJ_API asj_status asj_detect_options_set(asj_detect_options *options, const char *key, const char *text,
                                          char *message, size_t message_size);

/* Writes the value of one option as text that asj_detect_options_set() reads back to the same value. Takes former keys too.
 * ASJ_ERROR_ARGUMENT: a NULL pointer or too little room (64 bytes always do); ASJ_ERROR_OPTION: unknown key. */
ASJ_API asj_status asj_detect_options_get(const asj_detect_options *options, const char *key, char *text, size_t text_size);

#ifdef __cplusplus
}
#endif
#endif
