# SPDX-License-Identifier: BSD-2-Clause
# Judges junctions of the sample room: awk -F, -f corners.awk TRUTH.csv FOUND.csv
# Prints: junctions found, and how many of them are right: paired one to one with true junctions, closest first, up to 3 px apart
# (the rule of tests/accuracy/score.h).

FNR == 1 { next }
NR == FNR { true_x[$1] = $2; true_y[$1] = $3; next }
!($1 in x) { x[$1] = $2; y[$1] = $3; found++ }

function distance(x1, y1, x2, y2) {
    return sqrt((x1 - x2) * (x1 - x2) + (y1 - y2) * (y1 - y2))
}

# The closest of the pairs that are left, as best_t and best_f; its distance, or -1.
function closest(    p, least, part) {
    least = -1
    for (p in pairs) {
        split(p, part, SUBSEP)
        if ((part[1] in partner) || (part[2] in taken))
            delete pairs[p]
        else if (least < 0 || pairs[p] < least) {
            least = pairs[p]; best_t = part[1]; best_f = part[2]
        }
    }
    return least
}

END {
    for (t in true_x)
        for (f in x)
            if ((d = distance(true_x[t], true_y[t], x[f], y[f])) <= 3)
                pairs[t, f] = d
    while (closest() >= 0) {
        partner[best_t] = best_f; taken[best_f] = 1; right++
    }
    printf "%d %d\n", found, right
}
