# SPDX-License-Identifier: BSD-2-Clause
"""The report: parts made of texts, tables, charts and pictures, as one HTML page and as JSON."""
import base64
import html
import json
import math
import os
from dataclasses import dataclass, field

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 1250px; margin: 2em auto; padding: 0 1em; color: #222; }
h1 { font-size: 1.6em; } h2 { margin-top: 2.2em; border-bottom: 1px solid #ccc; } h3 { margin-bottom: .3em; }
table { border-collapse: collapse; margin: .8em 0; font-size: 13px; display: block; overflow-x: auto; }
th, td { padding: .2em .6em; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid #999; vertical-align: bottom; white-space: normal; }
td.best { font-weight: bold; }
caption { text-align: left; color: #555; caption-side: bottom; padding-top: .3em; white-space: normal; }
figure { margin: 1em 0; } figcaption { color: #555; font-size: 13px; } img, svg { max-width: 100%; height: auto; }
.cut { background: #fff4d6; padding: .5em 1em; } code { background: #f2f2f2; padding: 0 .2em; }
"""


@dataclass
class Part:
    title: str
    blocks: list = field(default_factory=list)    # HTML
    numbers: dict = field(default_factory=dict)   # for report.json
    findings: list = field(default_factory=list)  # sentences for the head of the page
    cut: list = field(default_factory=list)       # what was left out, and why
    cost: dict = field(default_factory=dict)      # kind of job -> seconds of processor time
    seconds: float = 0.0
    processor: float = 0.0                        # seconds of processor time, of programs too

    def account(self, jobs):
        """What the jobs left out, and what they took."""
        self.cut, self.cost = jobs.cut, {k: round(v, 1) for k, v in jobs.cost.items()}

    def heading(self, text):
        self.blocks.append("<h3>%s</h3>" % html.escape(text))

    def text(self, *paragraphs):
        self.blocks += ["<p>%s</p>" % html.escape(p) for p in paragraphs]

    def table(self, header, rows, caption="", best=()):
        """best: (row, column) of cells to set in bold"""
        out = ["<table><thead><tr>%s</tr></thead><tbody>" % "".join("<th>%s</th>" % html.escape(str(h)) for h in header)]
        for r, row in enumerate(rows):
            cells = "".join('<td%s>%s</td>' % (' class="best"' if (r, c) in best else "", html.escape(str(v)))
                            for c, v in enumerate(row))
            out.append("<tr>%s</tr>" % cells)
        out.append("</tbody>%s</table>" % ("<caption>%s</caption>" % html.escape(caption) if caption else ""))
        self.blocks.append("".join(out))

    def chart(self, svg, caption=""):
        self.blocks.append("<figure>%s<figcaption>%s</figcaption></figure>" % (svg, html.escape(caption)))

    def picture(self, data, kind, caption=""):
        """data: bytes of a file; kind: png or jpeg"""
        uri = "data:image/%s;base64,%s" % (kind, base64.b64encode(data).decode())
        self.blocks.append('<figure><img alt="%s" src="%s"><figcaption>%s</figcaption></figure>'
                           % (html.escape(caption), uri, html.escape(caption)))


def _part_html(key, part):
    out = ['<h2 id="%s">%s</h2>' % (key, html.escape(part.title))]
    if part.cut:
        out.append('<div class="cut"><b>Left out:</b><ul>%s</ul></div>' % "".join("<li>%s</li>" % html.escape(c) for c in part.cut))
    return "\n".join(out + part.blocks + [
        "<p><small>%.0f s; %.0f s of processor time</small></p>" % (part.seconds, part.processor)])


def _findings_html(parts):
    lines = ["<li>%s</li>" % html.escape(f) for p in parts.values() for f in p.findings]
    lines += ["<li><b>%s: %d things left out</b>, listed there</li>" % (html.escape(p.title), len(p.cut))
              for p in parts.values() if p.cut]
    return "<h3>Findings</h3><ul>%s</ul>" % "".join(lines) if lines else ""


def _plain(value):
    """For JSON: no NaN, no numpy, no tuples as keys."""
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def _part_data(part):
    return {"seconds": round(part.seconds, 1), "processor_seconds": round(part.processor, 1), "cost": part.cost,
            "left_out": part.cut, "findings": part.findings, "numbers": _plain(part.numbers)}


def write(folder, about, parts):
    """about: {what: text} for the head of the page. Returns the path of the page."""
    os.makedirs(folder, exist_ok=True)
    head = "".join("<tr><th>%s</th><td style='text-align:left'>%s</td></tr>" % (html.escape(k), html.escape(str(v)))
                   for k, v in about.items())
    contents = "".join('<li><a href="#%s">%s</a></li>' % (k, html.escape(p.title)) for k, p in parts.items())
    page = ("<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>libasj: experiments</title><style>%s</style></head>"
            "<body><h1>libasj: the paper's experiments</h1><table>%s</table><h3>Parts</h3><ol>%s</ol>%s%s</body></html>\n"
            % (STYLE, head, contents, _findings_html(parts), "\n".join(_part_html(k, p) for k, p in parts.items())))
    path = os.path.join(folder, "report.html")
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
    data = {"about": about, "parts": {k: _part_data(p) for k, p in parts.items()}}
    with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as file:
        json.dump(data, file, indent=1)
        file.write("\n")
    return path
