/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_MATCH_H
#define ASJ_MATCH_H

#include <asj/context.h>
#include <asj/geometry.h>
#include <asj/image.h>
#include <asj/junction.h>
#include <asj/options.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How patches are compared (asj_match_options.patches). */
enum {
    ASJ_PATCHES_CANONICAL = 0, /* each L-junction is sampled once in its own affine frame; all pairs compare by a product */
    ASJ_PATCHES_INDUCED = 1    /* the paper: a fixed pixel neighbourhood, warped by the pair's own map, both directions summed */
};

/* What describes a patch (asj_match_options.descriptor). */
enum {
    ASJ_DESCRIPTOR_RAW = 0, /* its grey levels */
    ASJ_DESCRIPTOR_SIFT = 1 /* 4 x 4 histograms of 8 gradient orientations, square-rooted (RootSIFT) */
};

/* Options of asj_match(). Fill with asj_match_options_init(), then change fields or call asj_match_options_set(). By step, as
 * src/README.md lists them; src/match/match_options.c holds the same table with ranges. Comments as in options.h; preset match is
 * default here. */
typedef struct asj_match_options {
    /* frames of L-junctions */
    double minimum_opening;      /* deg: branches that open by less, or by more than 180 minus this, give no frame. 0 .. 80; 20 */
    int32_t length_hypotheses;   /* lengths tried for a branch: its own, and junctions that lie on it. 1 .. 4; 3; paper 1 */
    /* description */
    int32_t patches;             /* ASJ_PATCHES_...; canonical; paper induced */
    int32_t descriptor;          /* ASJ_DESCRIPTOR_...; raw */
    int32_t normalise;           /* 1 = raw patches are brought to zero mean and unit norm. 1; paper 0 */
    int32_t patch_size;          /* samples along a side of a patch, a multiple of 4. 8 .. 24; 16 */
    int32_t reserved_integer;    /* zero */
    double window_start;         /* a canonical patch reaches from here .. -1 .. 0; -0.25 */
    double window_end;           /* .. to here, in branch lengths. 0.25 .. 2; 1 */
    double patch_radius;         /* px: half a side of an induced patch. 4 .. 64; 16 */
    double smoothing;            /* px: standard deviation of the blur before anything is sampled. 0 .. 2; 0.8; paper 0 */
    /* unrelated images */
    double related_support;      /* images whose likeliest candidates agree less than this have nothing in common and are answered
                                  * at once, without matches; 0 = none are. With a geometry asked these, and those that agree less
                                  * than 3.5 times as much, have a first look for one, by which most are answered, and these have
                                  * no matches where none is accepted. 0 .. 64; 0.14; paper 0 */
    /* short list, and alignment of its pairs */
    int32_t shortlist;           /* best candidates kept for each L-junction of either image. 1 .. 32; 4; paper 16 */
    int32_t align_iterations;    /* Gauss-Newton steps for the pair's own map, twice as many with junctions of octave -1, but for
                                  * candidates of a geometry; 0 = none.
                                  * 0 .. 30; 6; paper 0 */
    double align_radius;         /* px: radius of the disc around the junction that is aligned. 8 .. 64; 20 */
    double max_move;             /* px an alignment may move the junction. 0.5 .. 20; 8 */
    /* support by neighbouring candidates */
    int32_t neighbours;          /* nearest junctions asked for support; 0 = none. 0 .. 64; 40; paper 0 */
    int32_t guided_rounds;       /* times that accepted matches propose matches near them. 0 .. 4; 1; paper 0 */
    double minimum_support;      /* neighbours' agreement (each counts 0 to 1) that a match needs; with no neighbours none is
                                  * needed. 0 .. 64; 1.5; paper 0 */
    double neighbour_tolerance;  /* error of a predicted neighbour, as a part of the distance. 0.01 .. 1; 0.08 */
    double map_tolerance;        /* relative difference allowed between the affine maps of neighbours. 0.05 .. 5; 0.5 */
    /* assignment */
    double ratio;                /* the second best at another place must be worse by this factor. 1 .. 10; 1.5 */
    double separation;           /* px: what is nearer is the same place; "another place" lies farther. 0 .. 100; 6; paper 0 */
    int32_t mutual;              /* 1 = each must be the other's best. 1; paper 0 */
    /* verification by the matches around */
    int32_t verify_neighbours;   /* nearest matches, in either image, asked about a match; 0 = none, and the epipolar lines of 20
                                  * matches and more are not asked either (src/match/epipolar.c). 0 .. 64; 16; paper 0 */
    double verify_distance;      /* px at which such a neighbour counts by half. 10 .. 10000; 100 */
    double verify_agreement;     /* mean agreement with them that a match needs, of T-junctions half as much again. 0 .. 1, but
                                  * from 0.92 on none stays (src/match/verify.c); 0.28; paper 0 */
    /* line segments */
    double end_tolerance;        /* lengths of branches that explain each other agree within this part, and ends that
                                  * correspond within a sixth of it, or 4 px. 0.01 .. 1; 0.12 */
    /* asj_match_images(): images that are looked at upsampled by two as well, with junctions of octave -1 */
    int32_t upsample_from;       /* automatically: from so many matches on they are, also from fewer on where a geometry is
                                  * asked and left open; 0 = never. 0 .. 1000000; 8; paper 0 */
    int32_t upsampled_half_octaves; /* 1 = also half-way between their octaves: half as many right matches again, in 1.3 to 1.6
                                  * times the time. 1; paper 0 */
    double upsampled_search_radius; /* L-junctions are compared that lie no farther from where the images' own matches put them, if
                                  * there are eight and no geometry is left open; in diagonals of the images, and 0.3 of the
                                  * distance to these matches; 0 = anywhere. 0 .. 1; 0.02; paper 0 */
    int32_t upsampled_shortlist; /* .. and then this stands for shortlist; 0 = shortlist does. 0 .. 32; 2; paper 0 */
    int32_t upsampled_max_junctions; /* junctions of an upsampled image that take part, the most meaningful ones; 0 = all, which
                                  * takes a minute where two megapixels are full of texture. 0 .. 1000000; 16000 */
    int32_t look_at_colours;     /* 1 = automatically: where a geometry is asked and none is accepted, or none that is sure
                                  * (src/match/looks.c), or a motion without its pose, 8-bit colour images are looked at once more,
                                  * with asj_detect_options.colours, unless these have hardly anything in common. 1; paper 0 */
    int32_t reserved_switch;     /* zero */
    double reserved[16];         /* zero */
    /* two-view geometry; not among the options with a key. model: none, the default, and then the rest of it does not matter. Sizes
     * of the images are filled in */
    asj_geometry_options geometry;
} asj_match_options;

/* As for the detector: see options.h. */
ASJ_API void asj_match_options_init(asj_match_options *options);
ASJ_API asj_status asj_match_options_preset(asj_match_options *options, int32_t preset);
ASJ_API size_t asj_match_option_count(void);
ASJ_API const asj_option_info *asj_match_option(size_t index);
ASJ_API asj_status asj_match_options_set(asj_match_options *options, const char *key, const char *text,
                                         char *message, size_t message_size);
ASJ_API asj_status asj_match_options_get(const asj_match_options *options, const char *key, char *text, size_t text_size);

/* What is known about the end of a matched branch. Two ends correspond when the maps of the matches around put either of them
 * within 4 px (or a part of the length: end_tolerance) of the other, 3 px when what is at them differs; the border of an image
 * corresponds to nothing. */
enum {
    ASJ_END_CUT = 0,   /* they do not: the longer branch was cut where the matches around, and its epipolar line, put the
                        * end of the shorter one, or nearer, where they do not know that */
    ASJ_END_INNER = 1, /* a junction on one of the branches, or on each, corresponds to the other's end */
    ASJ_END_BOTH = 2,  /* both branches' own ends correspond */
    ASJ_END_CORNER = 3 /* of line segments: a corner that is matched */
};

/* Two L-junctions that show the same corner. */
typedef struct asj_junction_match {
    uint32_t l1, l2;        /* L-junctions, as asj_decompose() numbers them with options.minimum_opening */
    uint32_t junction1, junction2; /* whose they are: indices of those given; of asj_match_images() as it says */
    double affine[6];       /* h11 h12 h13 h21 h22 h23: x2 = h11 x1 + h12 y1 + h13, y2 = h21 x1 + h22 y1 + h23 */
    float x1, y1;           /* px: junction in image 1, as detected */
    float x2, y2;           /* px: where the aligned map puts it in image 2; as detected when it was not aligned */
    float ax1, ay1, bx1, by1; /* ends of the parts of both branches that correspond, image 1. Their distance from (x1, y1) or
                               * (x2, y2) is as found, their direction the mean of what both images say, carried over by the map
                               * and weighted by the branches' angle_sd: a little off the branch, an end may lie outside the
                               * image. On the branch as detected when one of the two is not known (angle_sd not above 0) */
    float ax2, ay2, bx2, by2; /* image 2 */
    int32_t end_a, end_b;   /* ASJ_END_... */
    float distance;         /* of the patches; see compare.c. The smaller the better */
    float ratio;            /* how much worse the second best at another place is; HUGE_VAL when there is none */
    float similarity;       /* correlation of the aligned discs, -1 .. 1; 0 when not aligned */
    float support;          /* neighbouring matches that agree, each counted 0 to 1 */
    float probability;      /* that the match is right, given the accepted geometry and, except in upsampled images, the candidates
                             * that are its rivals, of the 4000 most meaningful L-junctions of each image; 0 without a geometry.
                             * Off the plane of a homography it is low, and the match stays: there are other planes */
    float reserved;         /* zero */
} asj_junction_match;

/* Matches of two images. The arrays belong to the result and are NULL when empty. */
typedef struct asj_match_result {
    const asj_junction_match *matches; /* smallest distance first */
    const asj_l_junction *l_junctions1;/* what l1 and l2 count */
    const asj_l_junction *l_junctions2;
    uint32_t match_count;
    uint32_t l_junction_count1, l_junction_count2;
    int32_t backend;                   /* ASJ_BACKEND_...: what did the work */
    double total_ms;                   /* wall time of the call */
    double stage_ms[16];               /* by ASJ_STAGE_... */
    uint64_t candidates;               /* pairs among which the matches were chosen: aligned or compared by the pair's own map,
                                        * those that other matches or a geometry proposed too */
    asj_geometry geometry;             /* status not asked where options->geometry.model is none */
    uint64_t origin;                   /* the library's, which tells its own results by it; set it to 0 in a result that you put
                                        * together or copy */
    const asj_junction_match *rejected;/* matches that there would be without the geometry, or by that of one look, and that it
                                        * contradicts; with two at odds (ASJ_GEOMETRY_AMBIGUOUS) what either contradicts; smallest
                                        * distance first */
    uint32_t rejected_count;
    int32_t upsampled;                 /* 1 = the matches of the upsampled images are among them, with junctions of octave -1
                                        * (src/match/upsampled.c) */
    double stretch[2];                 /* along x and y, how the images were looked at: asj_match_images(); 1, 1 = as they are */
    int32_t coloured;                  /* 1 = found with the detector's colours, which were looked at by themselves */
    int32_t reserved_integer;
    uint64_t reserved[7];
} asj_match_result;

/* Matches the junctions of two images: the pipeline of the paper, step 7.
 *
 * With options->geometry.model the two-view geometry is estimated as well, from many more candidates than become matches
 * (geometry.h; src/match/two_view.c), by the matches and by candidates of the 4000 L-junctions of each image with the least log10
 * NFA. Where one is accepted, matches that contradict it go, and others that it makes likely come; where none is, the matches are
 * those that there are without (junctions of octave -1: see below). Junctions of other octaves than the finest are no candidates
 * (src/match/guests.c), but their matches go and come as others do. Where both images have colours, these count there, too, in what
 * is a candidate and how likely it is: things that repeat often differ in hue alone. Exposure and white balance may differ.
 *
 * With junctions of octave -1 (asj_detect_options.first_octave) the images are matched without those first, and then with them as
 * if they were twice as large. The second result holds where it has more matches, three in ten of the first ones again and few that
 * contradict these, together with those of the first ones whose places no other match has; else the first one does
 * (src/match/upsampled.c). One geometry judges both; src/match/looks.c has the rules, and the numbers in them. It is that of the
 * second one, or, where it has none or loses the pose, that of the first one; of two that agree the surer one, whose pose is told
 * as the mean of both, each as well as it is known. Of two at odds the images decide by how well they agree with each
 * (picture_agreement), then much more evidence does, then which of them is upside down (rotation[4] < 0); otherwise they are
 * ASJ_GEOMETRY_AMBIGUOUS, and what either contradicts is rejected; of two planes the pose is left out.
 * Where the first one, of known cameras, has rivals or leaves its motion open, the second one holds,
 * whatever its matches, when it accepts the same pose or the rival's, or another one that is sure, with more evidence; only then
 * where the first one has no matches; and not when it accepts none, or one that is upside down, or less surely another one of a
 * motion that was open. Beside a rival that is sure by itself it needs much more evidence. Where the second one has rivals and much
 * more evidence for another pose than the first one has for that which it accepts, they are ASJ_GEOMETRY_AMBIGUOUS, too, unless the
 * images agree clearly better with the first one. Junctions of octave -1 alone (octaves 1) have no first ones to ask. Everything is
 * in pixels of the images.
 *
 * image1, image2   views; only read, and only during the call
 * junctions1, 2    from asj_detect() or a file; may be NULL when the count is 0. Junctions with branches that differ in
 *                  sharpness or certainty are all welcome: a false junction finds no partner, a missing one cannot be matched.
 *                  So detect with ASJ_PRESET_MATCH
 * options          NULL = preset `default`
 * result           on success *result belongs to the caller until asj_match_result_free()
 *
 * Each location takes part in one match at most; of those found with junctions of octave -1 no two lie within 1 px of each other in
 * both images (one corner that several octaves have found). The result does not depend on the number of threads, and swapping the
 * images swaps matches that are mutual, but for some at the limit of the epipolar test, whose samples go by their order. (So do
 * those of a geometry: poses of both orders differ by about what they tell of their errors, and a pair at the limit of chance may
 * be accepted in one order alone. Of matches in upsampled images up to a tenth differ.) Memory:
 * 2.7 bytes per pixel of both images, up to 13 of one while it is prepared, the patches (patch_size^2 x 2 bytes for each frame),
 * with a geometry and colours 386 bytes more for each frame, short lists, up to 400 bytes for each candidate, and who supports
 * whom, up to 540 MB where all agree with all that is near: two images of 12 megapixels with 55 000 and 60 000 L-junctions and 1.6
 * million candidates took 1.0 GB. Time: all pairs of L-junctions are looked at, so twice as many in either image take four times as
 * long (2 000 junctions of five branches at one point, 20 000 L-junctions that all look alike: some ten seconds). With a geometry,
 * four times as many candidates are aligned for it, and it takes a share of its own: two frames of a video with 1150 L-junctions
 * each and their focal length took 1.5 s in place of 0.2 s (one thread of a two-core Xeon; 0.9 s with two). How often the caller is
 * asked whether to go on: asj_progress_callback. One call at a time for a context.
 *
 * ASJ_ERROR_ARGUMENT   a NULL pointer; a junction that cannot be (asj_junction_check()), or lies more than ASJ_MAX_OUTSIDE px
 *                      outside its image
 * ASJ_ERROR_IMAGE, ASJ_ERROR_LIMIT, ASJ_ERROR_OPTION, ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE   as asj_detect()
 * ASJ_ERROR_LIMIT      also with more than 2^24 L-junctions. Junctions of octave -1 are left out instead, where they alone are more
 *                      or where their image is too large to be upsampled: the log tells of it (ASJ_LOG_INFO) */
ASJ_API asj_status asj_match(asj_context *context,
                             const asj_image *image1, const asj_junction *junctions1, size_t count1,
                             const asj_image *image2, const asj_junction *junctions2, size_t count2,
                             const asj_match_options *options, asj_match_result **result);

/* How much longer than it is an image is looked at: 1, 1 = as it is; 0, 0 = automatically. */
typedef struct asj_stretch {
    double x, y; /* factors along either axis, ASJ_MIN_STRETCH .. ASJ_MAX_STRETCH */
} asj_stretch;
#define ASJ_MIN_STRETCH 0.5
#define ASJ_MAX_STRETCH 8

/* From two images to their matches: asj_detect() and asj_match(), on both images stretched. Upsampled by two (2, 2), photographs of
 * up to some megapixels have about three times the matches, in three to eight times the time; automatically (0, 0), with half
 * octaves, about six times the matches, in five to nine times the time. A surface that is seen at a glancing angle, like a
 * magazine on a table, matches stretched across it (1, 3) where it did not at all (tests/accuracy/README.md). Everything in the
 * result is in pixels of the images as they are. Junctions are numbered as the detector lists them in this call; where it has
 * looked twice (result->upsampled), first those with octave -1, by place, and after them, with their L-junctions, those of the
 * images without it. Times are those of all of it; result->stretch says how the images were looked at.
 *
 * stretch          NULL = as they are. Automatically (0, 0):
 *                  - as they are;
 *                  - where that gives options->upsample_from matches, also with junctions of octave -1, which hold as asj_match()
 *                    says (result->upsampled), and half octaves (options->upsampled_half_octaves), unless detect_options name
 *                    another first octave, or one octave alone, or an image has more than 2 megapixels. A pose of the images, with
 *                    known cameras also a geometry without one, is estimated again from these matches: of two that agree the mean
 *                    is told where they hold, two at odds are decided or ASJ_GEOMETRY_AMBIGUOUS, and of rivals the one is
 *                    accepted that they accept, too, or that they have much more evidence for. Another geometry of the images
 *                    judges them. Where the images have rivals or leave the motion open, with known cameras no match is needed to
 *                    look, and without, where they have no geometry, one is enough;
 *                  - with more than 2 megapixels both, and the same detect_options, also halved until one of them has no more
 *                    (0.5, 0.5; 0.25, 0.25; ...), and upsampled from there: where it is more matches, with a geometry asked of one
 *                    that is accepted, that is the answer (photographs with soft pixels have several times the matches);
 *                  - where a geometry is asked, none is accepted that is sure and tells a motion, and no rival is sure, also with
 *                    the detector's colours, if both images have some (options->look_at_colours): where that is accepted, and the
 *                    images' best was chance, or has much less evidence, it is the answer, of a motion that stays open also where
 *                    that allows it, and of rivals where it is one of them;
 *                  - where there are fewer than 16 matches then, with a geometry asked 16 that one holds together and 32 where it
 *                    tells no pose, also stretched by 1, 3 and by 3, 1, those halved as above, unless rivals or a motion that stays
 *                    open (ASJ_GEOMETRY_AMBIGUOUS, _DEGENERATE) are the answer. What comes of that counts from 16 matches on, and
 *                    when it is twice as many; then it is looked at with octave -1, too, as above.
 *                  A pair that has nothing in common takes a quarter longer than without all that (tests/benchmark/README.md).
 *                  Where one of these looks shows more L-junctions than the matcher takes, the answer without it stays
 * detect_options   NULL = preset `match`
 * options          NULL = preset `default`; cameras are those of the images as they are
 *
 * Memory: the stretched images besides what the two calls need for images of that size. One call at a time for a context.
 * ASJ_ERROR_OPTION  also for a stretch outside its range
 * ASJ_ERROR_LIMIT   also when a stretched image has more pixels than the library takes
 * Others as asj_detect() and asj_match() */
ASJ_API asj_status asj_match_images(asj_context *context, const asj_image *image1, const asj_image *image2,
                                    const asj_stretch *stretch, const asj_detect_options *detect_options,
                                    const asj_match_options *options, asj_match_result **result);

/* Frees a result and sets the pointer to NULL. NULL and a pointer to NULL are fine. */
ASJ_API void asj_match_result_free(asj_match_result **result);

/* A pair of line segments from image 1 and image 2: a matched branch. */
typedef struct asj_segment_match {
    uint32_t match;           /* index of the match it comes from */
    int32_t end;              /* ASJ_END_... of the far end */
    float x1, y1, ex1, ey1;   /* image 1: the junction's end, the far end */
    float x2, y2, ex2, ey2;   /* image 2 */
    int32_t branch1, branch2; /* which branches of the match's junction1 and junction2; -1: its l1 or l2 has no L-junction */
    int32_t start;            /* ASJ_END_... of the junction's end: ASJ_END_CORNER, joined ones also less */
} asj_segment_match;

/* The matches as line-segment matches: the two branches of each match, then the other branches of the same two junctions that
 * the map takes to each other, in their directions as detected; those whose far ends correspond at least as `minimum_end` says
 * (ASJ_END_...), by the end_tolerance of the call that made the result, or the default where the caller has put it together or
 * copied it; what is at the ends of those other branches is not asked. A pair found from both its ends comes once. Writes at most
 * `capacity` of them and returns how many there are in all (ASJ_MAX_BRANCHES x match_count at most). Time: proportional to the
 * matches (20 000 of two branches: 40 ms, 10 000 of three: .2 s); for a result that the caller has put together or copied, to their
 * square (20 000 of two: 4 s). */
ASJ_API size_t asj_match_segments(const asj_match_result *result, int32_t minimum_end,
                                  asj_segment_match *segments, size_t capacity);

/* Joins, in place, those that are parts of one edge: an edge with corners on it has a segment from each of them to its end. Two are
 * of one edge when they lie within 2 px of one line in both images, in the same order, share more than 4 px and 5 % of the shorter
 * one (12 px are enough), or the shorter lies in the longer, and both images agree on which goes on beyond the other. What comes of
 * them reaches from the first end to the last in both images; match, branch1, branch2 are those of one of its parts, mostly the
 * longest, and either end may be a matched corner (`start`, `end`) or not. Returns how many there are then, in the order of their
 * matches; joined again they stay as they are. The order in which they come changes nothing. Time: `count` times what it returns
 * (5000 that share nothing: .1 s, 20 000: 2 s), again each time that ends have moved. */
ASJ_API size_t asj_join_segment_matches(asj_segment_match *segments, size_t count);

#ifdef __cplusplus
}
#endif
#endif
