/* SPDX-License-Identifier: BSD-2-Clause */
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
enum { RAMP_STEPS = sizeof ramp / sizeof ramp[0] - 1 };

cli_color cli_ramp_color(double log10_nfa)
{
    double t = (log10_nfa - CLI_RAMP_UNSURE) / (CLI_RAMP_SURE - CLI_RAMP_UNSURE);
    t = t > 0 ? (t < 1 ? t : 1) : 0; /* 0 for NaN */
    int step = (int)(t * RAMP_STEPS);
    if (step == RAMP_STEPS)
        step--;
    double part = t * RAMP_STEPS - step, mixed[3];
    for (int i = 0; i < 3; i++)
        mixed[i] = ramp[step][i] + part * (ramp[step + 1][i] - ramp[step][i]);
    return from_bytes(mixed);
}

/* The five of Okabe and Ito's palette (2008) that stand out on a light ground. */
cli_color cli_branch_color(int32_t branch)
{
    static const double palette[5][3] = {
        {0x00, 0x72, 0xb2}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73}, {0xcc, 0x79, 0xa7}, {0xe6, 0x9f, 0x00},
    };
    return from_bytes(palette[branch % 5]);
}
