# SPDX-License-Identifier: BSD-2-Clause
"""The layout of the matching tables."""
import numpy as np


def accuracy(cell):
    """Percent; a pair without a match counts as 0."""
    return 100.0 * cell["correct"] / cell["total"] if cell["total"] else 0.0


def summary(cells):
    """Totals over pairs: average accuracy in percent, correct, total, mean seconds."""
    return {"average": float(np.mean([accuracy(c) for c in cells])), "correct": sum(c["correct"] for c in cells),
            "total": sum(c["total"] for c in cells), "seconds": float(np.mean([c["seconds"] for c in cells]))}


def finding(what, methods, names, cells):
    """One sentence: average accuracy and correct matches of every method that has all the pairs."""
    parts = []
    for method in methods:
        mine = [cells[method, n] for n in names if (method, n) in cells]
        if mine and len(mine) == len(names):
            all_of = summary(mine)
            parts.append("%s %.1f %% (%d / %d)" % (method, all_of["average"], all_of["correct"], all_of["total"]))
    return "%s, average accuracy: %s." % (what, "; ".join(parts))


def like(what, methods, names, cells):
    """One sentence: what every method makes of the pairs that a method has which has some of the pairs alone, or None."""
    known = {m: {n for n in names if (m, n) in cells} for m in methods}
    partly = [shared for shared in known.values() if shared and len(shared) < len(names)]
    if not partly:
        return None
    shared = [n for n in names if all(n in some for some in partly)]
    return finding("%s, %d pairs that all have" % (what, len(shared)), methods, shared, cells) if shared else None


def accuracy_rows(methods, names, cells):
    """(header, rows): method, average accuracy, correct / total, seconds a pair, then every pair.
    cells: (method, pair) -> counts"""
    header = ["method: correct / total of every pair", "average accuracy, %", "correct / total", "s a pair"] + list(names)
    rows = []
    for method in methods:
        mine = {n: cells[method, n] for n in names if (method, n) in cells}
        if not mine:
            continue
        all_of = summary(mine.values())
        partly = "" if len(mine) == len(names) else " (%d pairs)" % len(mine)
        seconds = "-" if np.isnan(all_of["seconds"]) else "%.2f" % all_of["seconds"]
        row = [method, "%.1f%s" % (all_of["average"], partly), "%d / %d" % (all_of["correct"], all_of["total"]), seconds]
        rows.append(row + ["%d / %d" % (mine[n]["correct"], mine[n]["total"]) if n in mine else "-" for n in names])
    return header, rows
