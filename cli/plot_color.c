/* SPDX-License-Identifier: BSD-2-Clause */
/* Colours of branches and matches. */
#include "plot_color.h"

static cli_color from_bytes(const double bytes[3])
{
    cli_color color = {bytes[0] / 255, bytes[1] / 255, bytes[2] / 255};
    return color;
}

/* Even steps in OkLCh (B. Ottosson 2020): lightness 0.80 .. 0.35, hue 80 .. -95 degrees, chroma 0.19 or what sRGB allows. The
 * lightness falls all the way, so that the order can be read without seeing the hues. */
static const double ramp[][3] = {
    {0xf4, 0xb0, 0x0c}, {0xfb, 0x8b, 0x09}, {0xf9, 0x65, 0x3b}, {0xe4, 0x4a, 0x65}, {0xc6, 0x39, 0x83},
    {0xa1, 0x30, 0x9a}, {0x77, 0x2b, 0xa7}, {0x4a, 0x27, 0xa8}, {0x08, 0x25, 0x9b},
};

/* Even steps in OkLCh too: lightness 0.60, hue 25 .. 325 degrees, chroma 0.21 or what sRGB allows. */
static const double wheel[][3] = {
    {0xe2, 0x34, 0x39}, {0xc8, 0x5d, 0x02}, {0xab, 0x73, 0x02}, {0x92, 0x81, 0x03}, {0x6c, 0x8e, 0x03}, {0x05, 0x9a, 0x46},
    {0x07, 0x95, 0x7c}, {0x00, 0x92, 0x98}, {0x09, 0x8d, 0xb2}, {0x06, 0x83, 0xdf}, {0x61, 0x6b, 0xfa}, {0x96, 0x57, 0xe8},
    {0xbb, 0x46, 0xc3},
};

/* Between the rows of a table with `steps` + 1 of them; t outside [0, 1] is taken to its nearer end. */
static cli_color mix(const double (*table)[3], int steps, double t)
{
    t = t > 0 ? (t < 1 ? t : 1) : 0; /* 0 for NaN */
    int step = (int)(t * steps);
    if (step == steps)
        step--;
    double part = t * steps - step, mixed[3];
    for (int i = 0; i < 3; i++)
        mixed[i] = table[step][i] + part * (table[step + 1][i] - table[step][i]);
    return from_bytes(mixed);
}

cli_color cli_ramp_color(double log10_nfa)
{
    return mix(ramp, sizeof ramp / sizeof ramp[0] - 1, (log10_nfa - CLI_RAMP_UNSURE) / (CLI_RAMP_SURE - CLI_RAMP_UNSURE));
}

cli_color cli_order_color(double place)
{
    return mix(wheel, sizeof wheel / sizeof wheel[0] - 1, place);
}

/* The five of Okabe and Ito's palette (2008) that stand out on a light ground. */
cli_color cli_branch_color(int32_t branch)
{
    static const double palette[5][3] = {
        {0x00, 0x72, 0xb2}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73}, {0xcc, 0x79, 0xa7}, {0xe6, 0x9f, 0x00},
    };
    return from_bytes(palette[branch % 5]);
}
