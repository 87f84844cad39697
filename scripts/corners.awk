# SPDX-License-Identifier: BSD-2-Clause
# Counts the corners of the sample room that were found: awk -F, -f corners.awk TRUTH.csv FOUND.csv
# Prints: corners in view, how many of them were found, junctions found, how many of those are at no true junction, and the
# median distance of the found corners in px.
#
# The rules are those of tests/accuracy/score.h. A corner counts as in view when two of its edges open by 25 to 155 degrees, are
# at least 10 px long and have a contrast of at least 10 grey levels, and no other true junction lies within 8 px of it. Junctions
# are paired one to one, closest first, up to 3 px apart.

FNR == 1 { next }
NR == FNR {
    if (!($1 in true_x))
        truths++
    true_x[$1] = $2; true_y[$1] = $3
    n = edges[$1]++
    angle[$1, n] = $6; usable[$1, n] = $7 >= 10 && $8 >= 10
    next
}
!($1 in x) { x[$1] = $2; y[$1] = $3; found++ }

function distance(x1, y1, x2, y2) {
    return sqrt((x1 - x2) * (x1 - x2) + (y1 - y2) * (y1 - y2))
}

function in_view(t,    i, k, open, u) {
    for (u in true_x)
        if (u != t && distance(true_x[t], true_y[t], true_x[u], true_y[u]) < 8)
            return 0
    for (i = 0; i < edges[t]; i++)
        for (k = 0; k < i; k++) {
            open = angle[t, i] - angle[t, k]
            open = atan2(sin(open), cos(open)) * 57.29577951308232
            if (open < 0)
                open = -open
            if (usable[t, i] && usable[t, k] && open >= 25 && open <= 155)
                return 1
        }
    return 0
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

function median(    i, k, swap) {
    for (i = 1; i <= hits; i++)
        for (k = i; k > 1 && error[k] < error[k - 1]; k--) {
            swap = error[k]; error[k] = error[k - 1]; error[k - 1] = swap
        }
    return hits ? (error[int((hits + 1) / 2)] + error[int((hits + 2) / 2)]) / 2 : 0
}

END {
    for (t in true_x)
        for (f in x)
            if ((d = distance(true_x[t], true_y[t], x[f], y[f])) <= 3)
                pairs[t, f] = d
    while ((d = closest()) >= 0) {
        partner[best_t] = best_f; apart[best_t] = d; taken[best_f] = 1; paired++
    }
    for (t in true_x)
        if (in_view(t)) {
            corners++
            if (t in partner)
                error[++hits] = apart[t]
        }
    printf "%d %d %d %d %.2f\n", corners, hits, found, found - paired, median()
}
