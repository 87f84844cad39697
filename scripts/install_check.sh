#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Installs the library into a folder of its own and uses it from there as other programs would: through pkg-config and CMake, from
# C99 and C++, shared and static; and without installing it, as a subproject of meson. The C programs of README.md are among them.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
cd "$work" # where meson asks CMake about the system (common.sh)
strict='-Wall -Wextra -Wpedantic -Wconversion -Wundef -Werror'

install_into() { # NAME OPTION...: not optimized, since it runs for seconds only
    prefix=$work/$1
    shift
    meson setup "$work/build" "$root" --prefix="$prefix" --libdir=lib -Dio=enabled -Dcli=enabled -Dtests=disabled \
        -Doptimization=0 "$@" &&
        meson install -C "$work/build" &&
        rm -rf "$work/build"
}

use_from() { # NAME: programs against what is installed there
    prefix=$work/$1
    PKG_CONFIG_PATH=$prefix/lib/pkgconfig
    LD_LIBRARY_PATH=$prefix/lib
    export PKG_CONFIG_PATH LD_LIBRARY_PATH
    static=
    [ "$1" = shared ] || static=--static
    if command -v cmake > /dev/null; then
        rm -rf "$work/cmake-build"
        cmake -S "$work/cmake" -B "$work/cmake-build" -DCMAKE_PREFIX_PATH="$prefix" > "$work/log" 2>&1 &&
            cmake --build "$work/cmake-build" >> "$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
        [ "$(env -u LD_LIBRARY_PATH "$work/cmake-build/core")" = "$version" ]
        [ "$(env -u LD_LIBRARY_PATH "$work/cmake-build/both")" = "$version" ]
    fi
    core="$(pkg-config --cflags asj) $work/core.c -o $work/core $(pkg-config $static --libs asj)"
    both="$(pkg-config --cflags asj-io) $work/both.c -o $work/both $(pkg-config $static --libs asj-io)"
    ${CC:-cc} -std=c99 $strict $core
    ${CC:-cc} -std=c99 $strict $both
    "$work/core" > "$work/core.txt"
    "$work/both" > "$work/both.txt"
    [ "$(cat "$work/core.txt")" = "$version" ] || { echo "core: $(cat "$work/core.txt") instead of $version"; exit 1; }
    [ "$(cat "$work/both.txt")" = "$version" ] || { echo "both: $(cat "$work/both.txt") instead of $version"; exit 1; }
    ${CXX:-c++} $strict -x c++ $both
    for program in "$work"/readme-*.c; do
        [ ! -e "$program" ] || ${CC:-cc} -std=c99 $(pkg-config --cflags asj-io) "$program" -o "$work/readme" \
            $(pkg-config $static --libs asj-io)
    done
    [ "$(env -u LD_LIBRARY_PATH "$prefix/bin/asj-cli" --version | grep -cF "$version")" -ge 1 ]
}

# moved, after use_from shared: what is installed may stand elsewhere, and CMake finds it there without pkg-config.
moved() {
    command -v cmake > /dev/null || return 0
    cp -R "$work/shared" "$work/moved"
    mv "$work/shared" "$work/away"
    rm -rf "$work/cmake-build"
    cmake -S "$work/cmake" -B "$work/cmake-build" -DCMAKE_PREFIX_PATH="$work/moved" -DPKG_CONFIG_EXECUTABLE=/nonexistent \
        > "$work/log" 2>&1 && cmake --build "$work/cmake-build" >> "$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
    [ "$(env -u LD_LIBRARY_PATH "$work/cmake-build/core")" = "$version" ]
    mv "$work/away" "$work/shared"
}

# fully_static, after use_from static: with the C library linked in too there is no dynamic loader, so no OpenCL, and nothing is
# said about it.
fully_static() {
    printf 'int main(void) { return 0; }\n' > "$work/empty.c"
    ${CC:-cc} -static "$work/empty.c" -o "$work/empty" -lm 2> /dev/null || { echo 'skipped: no static C library'; return 0; }
    ${CC:-cc} -std=c99 -static $(pkg-config --cflags asj) "$work/core.c" -o "$work/whole" $(pkg-config --static --libs asj) \
        2> "$work/log" || { cat "$work/log"; exit 1; }
    [ "$("$work/whole" 2>&1)" = "$version" ] || { echo 'a fully static program fails'; exit 1; }
}

# subproject: a project that asks for the static library gets it, and no shared one is built; files are read without the program.
# The project may put several files into one, its own.
subproject() {
    mkdir -p "$work/user/subprojects"
    cp "$work/core.c" "$work/user"
    ln -s "$root" "$work/user/subprojects/asj"
    cat > "$work/user/meson.build" << 'END'
project('user', 'c')
asj = dependency('asj', static: true, fallback: 'asj',
  default_options: ['io=enabled', 'cli=disabled', 'tests=disabled', 'optimization=0'])
executable('core', 'core.c', dependencies: asj)
END
    { meson setup "$work/user/build" "$work/user" --force-fallback-for=asj -Dunity=on && meson compile -C "$work/user/build"; } \
        > "$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
    [ "$("$work/user/build/core")" = "$version" ] || { echo 'the program of the parent project fails'; exit 1; }
    [ -z "$(find "$work/user/build" -name '*.so*')" ] || { echo 'static: true has built a shared library'; exit 1; }
}

# without_meson: the commands of src/README.md, not optimized.
without_meson() {
    mkdir "$work/hand"
    cp -R "$root/src" "$root/include" "$work/hand"
    awk '/^## Without Meson/ { here = 1 } /^```$/ { on = 0 } on; here && /^```sh$/ { on = 1 }' "$root/src/README.md" |
        sed 's/-O2/-O0/' > "$work/hand/build.sh"
    { (cd "$work/hand" && sh -eu build.sh) &&
        ${CC:-cc} -std=c99 -I "$root/include" "$work/core.c" "$work/hand/libasj.a" -o "$work/hand/core" -lm; } \
        > "$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
    [ "$("$work/hand/core")" = "$version" ] || { echo 'a program with what was compiled by hand fails'; exit 1; }
}

version=$(sh "$root/scripts/version.sh")
cat > "$work/core.c" << 'END'
#include <asj/asj.h>
#include <stdio.h>

int main(void)
{
    static unsigned char pixels[64 * 64];
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, 64, 64, 0, 0};
    asj_context *context = NULL;
    asj_detection *found = NULL;
    if (asj_context_create(NULL, &context) != ASJ_OK || asj_detect(context, &image, NULL, &found) != ASJ_OK)
        return 1;
    asj_detection_free(&found);
    asj_context_free(&context);
    puts(asj_version_string());
    return 0;
}
END
cat > "$work/both.c" << 'END'
#include <asj/asj.h>
#include <asj/io.h>
#include <stdio.h>

int main(void)
{
    char message[512];
    asj_image_file *file = NULL;
    if (asj_image_file_read("/nowhere/photo.png", 0, &file, message, sizeof message) != ASJ_ERROR_FILE)
        return 1;
    puts(asj_version_string());
    return 0;
}
END
mkdir "$work/cmake"
cp "$work/core.c" "$work/both.c" "$work/cmake"
cat > "$work/cmake/CMakeLists.txt" << 'END'
cmake_minimum_required(VERSION 3.12)
project(user C)
find_package(asj 0.1 QUIET COMPONENTS io no_such)
if(asj_FOUND)
  message(FATAL_ERROR "a component that is not there was found")
endif()
find_package(asj 0.1 REQUIRED COMPONENTS io OPTIONAL_COMPONENTS no_such)
if(NOT asj_io_FOUND OR asj_no_such_FOUND)
  message(FATAL_ERROR "components: io '${asj_io_FOUND}', no_such '${asj_no_such_FOUND}'")
endif()
add_executable(core core.c)
target_link_libraries(core asj::asj)
add_executable(both both.c)
target_link_libraries(both asj::io)
END
if [ -e "$root/README.md" ]; then # every C block with a main function
    awk -v to="$work/readme-" '/^```c$/ { n++; on = 1; text = ""; next }
        /^```$/ && on { on = 0; if (text ~ /int main/) printf "%s", text > (to n ".c") }
        on { text = text $0 "\n" }' "$root/README.md"
fi

{
    install_into shared &&
        install_into static -Ddefault_library=static &&
        meson setup "$work/build-of-both" "$root" -Ddefault_library=both -Dauto_features=disabled -Dtests=disabled
} > "$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
for file in bin/asj-cli lib/libasj.so lib/libasj-io.so lib/pkgconfig/asj.pc lib/pkgconfig/asj-io.pc lib/cmake/asj/asjConfig.cmake \
    share/man/man1/asj-cli.1 share/man/man5/asj-formats.5 share/man/man7/asj-options.7 share/man/man7/asj-paper.7 \
    $(cd "$root/include" && printf 'include/%s ' asj/*.h); do
    [ -s "$work/shared/$file" ] || { echo "not installed: $file"; exit 1; }
done
for file in lib/libasj.a lib/libasj-io.a; do
    [ -s "$work/static/$file" ] || { echo "not installed: $file"; exit 1; }
done
use_from shared
moved
[ -z "$(find "$work/static" -name '*.so*')" ] || { echo 'default_library=static has built shared libraries'; exit 1; }
use_from static
fully_static
subproject
without_meson
(cd "$work/shared" && find . -type f -o -type l | sort)
