# SPDX-License-Identifier: BSD-2-Clause
# Checks matches of the sample room: awk -F, -f matches.awk 1.csv 2.csv correspondences.csv MATCHES.csv
# Prints: true junctions that both views show, matches, and how many of those join the same true junction within 3 px in either
# view (tests/synth/sample_room.c writes the truth).

FNR == 1 { file++; next }
file < 3 { x[file, $1] = $2; y[file, $1] = $3; next }
file == 3 { first[++pairs] = $1; second[pairs] = $2; next }
{
    matches++
    for (k = 1; k <= pairs; k++)
        if (near(1, first[k], $3, $4) && near(2, second[k], $9, $10)) {
            correct++
            break
        }
}

function near(view, junction, px, py) {
    return (x[view, junction] - px) ^ 2 + (y[view, junction] - py) ^ 2 <= 9
}

END { printf "%d %d %d\n", pairs, matches, correct }
