#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""plan.py must see what it is there to see: plan_fails.py PLAN.py. Faults are planted in a small tree, one at a time."""
import os
import subprocess
import sys
import tempfile

CLEAN = {
    "include/asj/asj.h": "void asj_run(void);\n",
    "src/core/memory.h": "void asj_take(void);\nextern const int asj_sizes[2];\n",
    "src/core/memory.c": '#include "memory.h"\nvoid asj_take(void)\n{\n}\nconst int asj_sizes[2] = {1, 2};\n',
    "src/detect/scan.h": '#include "core/memory.h"\nvoid asj_scan(int width,\n              int height);\n',
    "src/detect/scan.c": '#include "scan.h"\n#include <asj/asj.h>\n'
                         "void asj_scan(int width,\n              int height)\n{\n    asj_take();\n}\n",
    "src/match/pair.c": '#include "core/memory.h"\n#include <asj/asj.h>\n'
                        "int pair(void)\n{\n    asj_run();\n    return asj_sizes[0];\n}\n",
    "src/simd/avx2.c": '#include "detect/scan.h"\n',
    "src/create.c": '#include "detect/scan.h"\n#include <asj/asj.h>\nvoid asj_run(void)\n{\n    asj_scan(1, 2);\n}\n',
    "cli/main.c": '#include <asj/asj.h>\n/* #include "core/memory.h": not an include */\nint main(void)\n{\n    asj_run();\n}\n',
}
# (what is planted, {file: text added to it}, what must be said; None = nothing)
CASES = [
    ("nothing", {}, None),
    ("an include that may be", {"src/detect/scan.c": '#include "core/memory.h"\n'}, None),
    ("a private header in the program", {"cli/main.c": '#include "core/memory.h"\n'}, "cli may not use src/core"),
    ("the detector in the core", {"src/core/other.c": '#include "detect/scan.h"\n'}, "src/core may not use src/detect"),
    ("the detector in the matcher", {"src/match/pair.c": '#include "../detect/scan.h"\n'}, "src/match may not use src/detect"),
    ("a vector form in a step", {"src/detect/scan.c": '#include "simd/form.h"\n', "src/simd/form.h": ""},
     "src/detect may not use src/simd"),
    ("a call without an include", {"src/match/pair.c": "void asj_scan(int, int);\nvoid other(void)\n{\n    asj_scan(1, 2);\n}\n"},
     "src/match may not use src/detect"),
    ("the kernels' header in a step", {"src/detect/scan.c": '#include "kernels/contract.h"\n', "kernels/contract.h": ""},
     "src/detect may not use kernels"),
    ("the kernels' header where they are run", {"src/cl/run.c": '#include "kernels/contract.h"\n', "kernels/contract.h": ""}, None),
    ("a folder of nobody", {"src/new/x.c": ""}, "src/new/x: src/new is no folder of the plan"),
    ("a folder in a folder", {"src/simd/x86/avx2.c": '#include "detect/scan.h"\n'}, None),
    ("a circle of includes", {"src/core/a.h": '#include "b.h"\n', "src/core/b.h": '#include "a.h"\n'},
     "circle: src/core/a src/core/b"),
    ("a circle of a header and a file",
     {"src/core/a.h": '#include "b.h"\n', "src/core/b.h": "", "src/core/b.c": '#include "a.h"\n'},
     "circle: src/core/a src/core/b"),
    ("a circle of calls", {"src/core/a.c": "void asj_a(void)\n{\n    asj_b();\n}\n",
                           "src/core/b.c": "void asj_b(void)\n{\n    asj_a();\n}\n"},
     "circle: src/core/a src/core/b"),
    ("a circle through a table", {"src/core/a.c": "const int asj_table = 1;\nint asj_a(void)\n{\n    return asj_b();\n}\n",
                                  "src/core/b.c": "int asj_b(void)\n{\n    return asj_table;\n}\n"},
     "circle: src/core/a src/core/b"),
]


def run(plan, files, *options):
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            full = os.path.join(root, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "w", encoding="ascii") as file:
                file.write(text)
        result = subprocess.run([sys.executable, plan, *options, root], capture_output=True, text=True, check=False)
        return result.returncode, result.stdout + result.stderr


def main(plan):
    failed = 0
    for what, planted, wanted in CASES:
        files = dict(CLEAN)
        for path, text in planted.items():
            files[path] = files.get(path, "") + text
        status, said = run(plan, files)
        good = status == 0 if wanted is None else status == 1 and wanted in said and len(said.splitlines()) == 1
        if not good:
            failed += 1
            print(f"{what}: exit status {status}, wanted {wanted!r}, said:\n{said}")
    status, said = run(plan, {"README": "nothing here"})
    if status == 0:
        failed += 1
        print(f"an empty tree passes:\n{said}")
    status, said = run(plan, CLEAN, "--report")
    if status != 0 or "5 modules in src, 3 levels, 0 circles" not in said:
        failed += 1
        print(f"--report: exit status {status}, said:\n{said}")
    print(f"{len(CASES) + 2} cases, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
