# SPDX-License-Identifier: BSD-2-Clause
"""Curves as inline SVG, by matplotlib."""
import io
import re
from itertools import count

import matplotlib

matplotlib.use("svg")
from matplotlib.figure import Figure  # noqa: E402

matplotlib.rcParams.update({"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9, "axes.grid": True,
                            "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False})
_serial = count(1)
STYLES = ("o-", "s--", "^-.", "v:", "D-", "x--", "P-.")


def _svg(figure):
    """The picture as one <svg> element whose ids are like no other chart's."""
    file = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "chart%d" % next(_serial)}):
        figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    text = file.getvalue()
    return re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg"):], flags=re.S)


def curves(panels, width=7.5, height=3.2):
    """panels: a list of {title, x_label, y_label, series: {name: (xs, ys)}, log, y_range, ticks}, side by side."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots(1, len(panels), squeeze=False)[0]
    for axis, panel in zip(axes, panels):
        for style, (name, (xs, ys)) in zip(STYLES * 3, panel["series"].items()):
            axis.plot(xs, ys, style, label=name, markersize=4, linewidth=1.3)
        axis.set(title=panel.get("title", ""), xlabel=panel.get("x_label", ""), ylabel=panel.get("y_label", ""))
        if panel.get("log"):
            axis.set(xscale="log", yscale="log")
        if panel.get("y_range"):
            axis.set_ylim(*panel["y_range"])
        if panel.get("ticks"):
            axis.set_xticks(panel["ticks"])
    entries = {}
    for axis in axes:
        entries.update(zip(*reversed(axis.get_legend_handles_labels())))
    columns = 2 if max(map(len, entries), default=0) > 30 else 4
    figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=columns, fontsize=8)
    return _svg(figure)
