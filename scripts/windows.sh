# SPDX-License-Identifier: BSD-2-Clause
# The library and the command line for Windows, by MinGW, under Wine where that is there. Sourced by machines.sh, which has set
# $root, $work, $cache and $machines.

windows_compiler=x86_64-w64-mingw32-gcc
windows_parts='-Dauto_features=disabled -Dthreads=enabled -Dsimd=enabled'

# windows_run LOG PROGRAM ARGUMENT...: what Wine says about itself goes to LOG, and what it sends is made of lines again.
windows_run() {
    log_of_wine=$1
    shift
    env WINEDEBUG=-all "WINEPREFIX=$work/wine" "$wine" "$@" < /dev/null 2> "$log_of_wine"
}

find_wine() {
    wine=$(command -v wine || command -v wine64)
    [ -n "$wine" ] || echo 'windows: not run (no wine)'
    [ -n "$wine" ]
}

# configured FOLDER OPTION...: a build folder, kept when its options are the same.
configured() {
    kept=$1
    shift
    [ -e "$kept/build.ninja" ] && [ "$(cat "$kept/.options" 2> /dev/null)" = "$*" ] && return 0
    rm -rf "$kept"
    mkdir -p "$kept" && (cd "$kept" && meson setup "$kept" "$root" --werror "$@") && printf '%s' "$*" > "$kept/.options"
}

# The library as a DLL, as the project builds it, with vector instructions and threads; what it exports are the functions of the
# headers.
try_windows() {
    folder=$work/windows
    parts=$windows_parts
    version=$(sh scripts/version.sh)
    case $version in # as src/meson.build has it
    0.*) dll=libasj-${version%.*}.dll ;;
    *) dll=libasj-${version%%.*}.dll ;;
    esac
    if ! command -v $windows_compiler > /dev/null; then
        echo "windows: skipped (no $windows_compiler)"
        return 0
    fi
    find_wine > "$work/wine.found" || parts="$parts -Doptimization=0" # it is built only, then
    printf "[binaries]\nc = ['%s']\n" "${cache:+$cache', '}$windows_compiler" > "$work/windows.ini"
    if ! { configured "$folder" --cross-file "$root/scripts/mingw-w64.ini" --cross-file "$work/windows.ini" $parts &&
        ninja -C "$folder" "src/$dll" &&
        $windows_compiler -std=c99 -O2 -Iinclude tests/machines/machine.c "$folder/src/libasj.dll.a" \
            -o "$folder/src/machine.exe"; } > "$work/windows.log" 2>&1; then
        tail -n 30 "$work/windows.log"
        echo 'windows: does not build'
        return 1
    fi
    sh tests/api/functions.sh $(ls include/asj/*.h | grep -v '/io\.h$') > "$work/declared"
    x86_64-w64-mingw32-objdump -p "$folder/src/$dll" |
        sed -n '/^\[Ordinal\/Name Pointer\]/,$ s/^[ \t]*\[[ 0-9]*\]\( +base\[[ 0-9]*\] *[0-9a-f]*\)\{0,1\} \([A-Za-z_]*\)/\2/p' |
        sort > "$work/exported"
    if ! diff "$work/declared" "$work/exported"; then
        echo 'windows: < declared and not exported, > exported and not declared'
        return 1
    fi
    echo "windows: builds, exports $(grep -c '' "$work/exported") functions"
    [ ! -s "$work/wine.found" ] || { cat "$work/wine.found"; return 0; }
    windows_run "$work/wine.log" "$folder/src/machine.exe" | tr -d '\r' > "$work/windows.txt"
    machines="$machines windows"
}

# source_lists: the system's own package lists, sources in place of programs.
source_lists() {
    rm -rf "$work/apt" && mkdir -p "$work/apt/parts" "$work/apt/lists/partial" || return 1
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/debian*.sources /etc/apt/sources.list.d/ubuntu*.sources; do
        [ ! -e "$list" ] || sed 's/^deb /deb-src /; s/^Types:.*/Types: deb-src/' "$list" > "$work/apt/parts/${list##*/}"
    done
    [ ! -e "$work/apt/parts/sources.list" ] || mv "$work/apt/parts/sources.list" "$work/apt/parts/own.list"
}

# windows_libraries: libpng and jansson, which Debian has no MinGW form of, from their sources into $work/libraries.
windows_libraries() {
    [ ! -e "$work/libraries/done" ] || return 0
    source_lists || return 1
    lists="-o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts=$work/apt/parts -o Dir::State::lists=$work/apt/lists"
    cat > "$work/windows.cmake" << END
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_C_COMPILER $windows_compiler)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
END
    (
        cd "$work/apt" && apt-get $lists update && apt-get $lists source --tar-only libpng1.6 jansson || exit 1
        for library in libpng1.6 jansson; do
            mkdir "$library" && tar -x -f "$library"_*.orig.tar.* -C "$library" --strip-components=1 || exit 1
            cmake -G Ninja -S "$library" -B "$library/build" "-DCMAKE_TOOLCHAIN_FILE=$work/windows.cmake" \
                -DCMAKE_BUILD_TYPE=Release "-DCMAKE_INSTALL_PREFIX=$work/libraries" -DPNG_SHARED=OFF -DPNG_TESTS=OFF \
                -DPNG_EXECUTABLES=OFF -DJANSSON_BUILD_DOCS=OFF -DJANSSON_EXAMPLES=OFF -DJANSSON_WITHOUT_TESTS=ON &&
                ninja -C "$library/build" install || exit 1
        done
    ) && : > "$work/libraries/done"
}

build_windows_program() {
    cat > "$work/libraries.ini" << END
[binaries]
pkgconfig = 'pkg-config'
[properties]
pkg_config_libdir = ['$work/libraries/lib/pkgconfig', '/usr/x86_64-w64-mingw32/lib/pkgconfig']
END
    windows_libraries || return 1
    configured "$work/windows-program" --cross-file "$root/scripts/mingw-w64.ini" --cross-file "$work/windows.ini" \
        --cross-file "$work/libraries.ini" $windows_parts -Dio=enabled -Dcli=enabled -Dprefer_static=true &&
        configured "$work/program" $windows_parts -Dio=enabled -Dcli=enabled -Dtests=enabled &&
        ninja -C "$work/windows-program" && ninja -C "$work/program" cli/asj-cli tests/synth/sample-room || return 1
    # The DLLs stand beside the program, as a folder that is handed on has them.
    rm -rf "$work/both" && mkdir -p "$work/both/here" "$work/both/there" &&
        cp "$work/windows-program/cli/asj-cli.exe" "$work"/windows-program/src/*.dll "$work"/windows-program/src/io/*.dll \
            "$work/both" && "$work/program/tests/synth/sample-room" "$work/both"
}

# both ARGUMENT...: asj-cli here and under Wine in the folder of the pictures; the word OUT is a folder of their own.
both() {
    (cd "$work/both" &&
        "$work/program/cli/asj-cli" $(echo "$*" | sed 's/OUT/here/g') > here/text 2> here/messages &&
        windows_run there/messages ./asj-cli.exe $(echo "$*" | sed 's/OUT/there/g') > there/text)
}

# The command line: the same bytes in every file as here.
try_windows_program() {
    if ! command -v $windows_compiler > /dev/null || ! command -v cmake > /dev/null ||
        [ ! -e /usr/x86_64-w64-mingw32/lib/libz.a ]; then
        echo "windows-program: skipped (no $windows_compiler, no cmake, or no libz-mingw-w64-dev)"
        return 0
    fi
    if ! build_windows_program > "$work/windows-program.log" 2>&1; then
        tail -n 30 "$work/windows-program.log"
        echo 'windows-program: does not build'
        return 1
    fi
    find_wine || return 0
    both detect -o OUT/one.asj 1.png && both detect --for matching --out-dir OUT/deep/er --format asj 1.png 2.png &&
        both match -o OUT/matches.csv 1.png 2.png && both detect -o OUT/one.csv 1.png && both detect -o OUT/one.asjf 1.png &&
        both match -o OUT/kept.csv OUT/one.asjf 2.png && both detect -o - 2.png || {
        echo 'windows-program: fails'
        return 1
    }
    for file in one.asj one.csv one.asjf deep/er/1.asj deep/er/2.asj matches.csv kept.csv text; do
        if ! [ -s "$work/both/here/$file" ] || ! cmp "$work/both/here/$file" "$work/both/there/$file"; then
            echo "windows-program: $file is not what it is here"
            return 1
        fi
    done
    echo "windows-program: detect and match write the same bytes; $(head -n 1 "$work/both/here/one.asj") junctions," \
        "$(($(grep -c '' "$work/both/here/matches.csv") - 1)) matches"
}
