# SPDX-License-Identifier: BSD-2-Clause
# Judges matches of the sample room: awk -F, -f matches.awk truth.json MATCHES.csv
# Prints: matches, and how many of them are right: in either view the point lies within 3 px of the line on which the other view and
# the true fundamental matrix F put it, x2' F x1 = 0 (tests/synth/sample_room.c writes F as a list of three rows).

FILENAME != truth && !truth { truth = FILENAME }
FILENAME == truth { text = text $0 ","; next }
FNR == 1 { read_matrix(); next }
{
    matches++
    x1 = $3; y1 = $4; x2 = $9; y2 = $10
    # F x1 is a line of view 2, F' x2 one of view 1; the residual over the length of its normal is the distance from it
    for (k = 0; k < 3; k++) {
        line2[k] = f[3 * k] * x1 + f[3 * k + 1] * y1 + f[3 * k + 2]
        line1[k] = f[k] * x2 + f[3 + k] * y2 + f[6 + k]
    }
    residual = x2 * line2[0] + y2 * line2[1] + line2[2]
    if (apart(residual, line1[0], line1[1]) <= 3 && apart(residual, line2[0], line2[1]) <= 3)
        right++
}

function read_matrix(    part, k) {
    sub(/.*"F": *\[\[/, "", text)
    gsub(/[][]/, " ", text)
    split(text, part, ",")
    for (k = 0; k < 9; k++)
        f[k] = part[k + 1] + 0
}

function apart(residual, a, b) {
    residual = residual < 0 ? -residual : residual
    return residual / sqrt(a * a + b * b)
}

END { printf "%d %d\n", matches, right }
