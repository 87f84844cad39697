#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""The plan of the sources, checked: plan.py [--report] ROOT

A module is a .c file and the header of its name; a header alone is one too. A module uses another when it includes its header, or
names a function or table that the other defines; public functions may be used from any folder. ALLOWED says which folder may use
which (src/README.md draws it). Fails when a module uses a folder that it may not, and when modules use each other in a circle.
--report prints how many levels there are (the longest way down, in modules), the circles, and the ways between the folders."""
import os
import re
import sys

# Folders are relative to ROOT; "src" alone is its top, where all is put together. Public headers may be used by all.
ALLOWED = {
    "include/asj": [],
    "kernels": [],  # the header that kernels and their hosts share
    "src/shared": [],  # what the core and libasj-io have to agree about
    "src/core": ["src/shared"],
    "src/segments": ["src/core"],
    "src/detect": ["src/core", "src/segments"],
    "src/geometry": ["src/core"],
    "src/match": ["src/core", "src/segments", "src/geometry"],  # and detect's results, which are public
    "src/simd": ["src/shared", "src/core", "src/detect", "src/geometry", "src/match"],
    "src/cl": ["src/core", "src/detect", "src/match", "kernels"],
    "src": ["src/core", "src/segments", "src/detect", "src/geometry", "src/match", "src/simd", "src/cl"],
    "src/io": ["src/shared"],
    "cli": [],  # the library through its public headers
}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<(asj/[^>]+)>)', re.MULTILINE)
COMMENT = re.compile(r'/\*.*?\*/|//[^\n]*', re.DOTALL)
STRING = re.compile(r'"(?:\\.|[^"\\\n])*"')
DIRECTIVE = re.compile(r'^[ \t]*#(?:\\\n|[^\n])*', re.MULTILINE)
NAME = re.compile(r'\basj_\w+')
FUNCTION = re.compile(r'^(?!static|typedef|extern)[A-Za-z_][\w \t*]*?\b(asj_\w+)[ \t]*\([^;{}]*\)\s*\{', re.MULTILINE)
TABLE = re.compile(r'^(?!static|typedef|extern)[A-Za-z_][\w \t*]*?\b(asj_\w+)(?:\[\w*\])*[ \t]*=[^=]', re.MULTILINE)


def folder_of(path):
    """The folder of the plan that a file lies in, however deep; the top of src holds its own files only."""
    folder = os.path.dirname(path)
    while folder not in ALLOWED and os.path.dirname(folder) not in ("", "src"):
        folder = os.path.dirname(folder)
    return folder


def sources(root):
    for top in ("include", "src", "cli", "kernels"):
        for path, folders, names in os.walk(os.path.join(root, top)):
            folders.sort()
            for name in sorted(names):
                if name.endswith((".c", ".h", ".cpp")):
                    yield os.path.relpath(os.path.join(path, name), root)


def module_of(path):
    return os.path.splitext(path)[0]


def resolve(path, included, files):
    """The file that an include means: beside the file, else from src, include or the root; None for what the build makes."""
    for folder in (os.path.dirname(path), "src", "include", ""):
        candidate = os.path.normpath(os.path.join(folder, included))
        if candidate in files:
            return candidate
    return None


def read_plan(root):
    """{module: {module it uses: why}}"""
    texts = {path: open(os.path.join(root, path), encoding="ascii").read() for path in sources(root)}
    bare = {path: DIRECTIVE.sub("", STRING.sub('""', COMMENT.sub(" ", text))) for path, text in texts.items()}
    owners = {}
    for path, text in bare.items():
        for name in FUNCTION.findall(text) + TABLE.findall(text):
            owners.setdefault(name, module_of(path))
    public = {name for path in texts if path.startswith("include/") for name in NAME.findall(bare[path])}
    uses = {module_of(path): {} for path in texts}
    for path, text in texts.items():
        module = module_of(path)
        for quoted, angled in INCLUDE.findall(COMMENT.sub(" ", text)):
            target = resolve(path, quoted or angled, texts)
            if target and module_of(target) != module:
                uses[module].setdefault(module_of(target), f"{path} includes {target}")
        for name in NAME.findall(bare[path]) if not path.endswith(".h") else []: # headers name what they declare
            owner = owners.get(name, module)
            if owner != module and (name not in public or folder_of(owner + ".c") == folder_of(path)):
                uses[module].setdefault(owner, f"{path} uses {name}() of {owner}.c")
    return uses


def find_circles(uses):
    """Groups of modules that reach each other (Tarjan), and the order from the bottom up."""
    index, low, stack, circles, order = {}, {}, [], [], []

    def visit(module):
        index[module] = low[module] = len(index)
        stack.append(module)
        for target in sorted(uses[module]):
            if target not in index:
                visit(target)
                low[module] = min(low[module], low[target])
            elif target in stack:
                low[module] = min(low[module], index[target])
        if low[module] == index[module]:
            group = stack[stack.index(module):]
            del stack[stack.index(module):]
            order.append(group)
            if len(group) > 1:
                circles.append(sorted(group))

    for module in sorted(uses):
        if module not in index:
            visit(module)
    return circles, order


def count_levels(uses, order):
    """Modules on the longest way down; those of a circle stand on one level."""
    level, most = {}, 0
    for group in order:
        below = [level[target] for module in group for target in uses[module] if target not in group]
        height = 1 + max(below, default=0)
        most = max(most, height)
        for module in group:
            level[module] = height
    return level, most


def forbidden(uses):
    found = []
    for module in sorted(uses):
        folder = folder_of(module)
        if folder not in ALLOWED:
            found.append(f"{module}: {folder} is no folder of the plan")
        for target, why in sorted(uses[module].items()):
            other = folder_of(target)
            if other not in (folder, "include/asj") and other not in ALLOWED.get(folder, [other]):
                found.append(f"{why}: {folder} may not use {other}")
    return found


def within(uses, prefixes):
    """The plan of the modules of some folders alone."""
    keep = {module for module in uses if module.startswith(prefixes)}
    return {module: {t: why for t, why in uses[module].items() if t in keep} for module in keep}


def report(uses):
    library = within(uses, "src/")
    circles, order = find_circles(library)
    level, most = count_levels(library, order)
    print(f"{len(library)} modules in src, {most} levels, {len(circles)} circles")
    for circle in circles:
        print("circle: " + " ".join(circle))
    ways = {}
    for module in library:
        for target in library[module]:
            pair = (folder_of(module), folder_of(target))
            if pair[0] != pair[1]:
                ways[pair] = ways.get(pair, 0) + 1
    for (folder, other), count in sorted(ways.items()):
        print(f"{folder} -> {other}: {count}")
    for height in range(most, 0, -1):
        print(f"level {height}: " + " ".join(sorted(m[len("src/"):] for m in level if level[m] == height)))


def main(arguments):
    wanted = [a for a in arguments if a != "--report"]
    if len(wanted) != 1:
        sys.exit("usage: plan.py [--report] ROOT")
    uses = read_plan(wanted[0])
    if not any(module.startswith("src/core/") for module in uses) and "--report" not in arguments:
        sys.exit(f"{wanted[0]}: no sources")
    if "--report" in arguments:
        report(uses)
        return 0
    faults = forbidden(uses) + ["circle: " + " ".join(circle) for circle in find_circles(uses)[0]]
    print("\n".join(faults) if faults else f"{len(uses)} modules: no forbidden way, no circle")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
