# SPDX-License-Identifier: BSD-2-Clause
# What demo.sh and test.sh share: messages, packages, build folders. Sourced after $root, the folder of the checkout, is set.
#
# Exit codes of both: 0 everything worked, 1 something failed, 2 wrong usage, 3 packages are missing and cannot be installed here.

logs=$root/out/log

say() {
    printf '%s\n' "$*"
}

fail() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# logged NAME COMMAND...: runs a command with its output in out/log/NAME.log; shows the end of that only when it fails.
logged() {
    log=$logs/$1.log
    shift
    if ! "$@" > "$log" 2>&1 < /dev/null; then
        tail -n 40 "$log" >&2
        printf '%s: failed: %s\n%s: the whole output is in %s\n' "${0##*/}" "$*" "${0##*/}" "$log" >&2
        return 1
    fi
}

# ---- packages ----

has_c() {
    printf '#include <stdio.h>\n#include <math.h>\n' | ${CC:-cc} -x c -fsyntax-only -
}

has_cxx() {
    printf '#include <string>\n' | ${CXX:-c++} -x c++ -fsyntax-only -
}

has_opencv() {
    [ -e /usr/include/opencv4/opencv2/imgcodecs.hpp ] || [ -e /usr/local/include/opencv4/opencv2/imgcodecs.hpp ] ||
        [ -e /opt/homebrew/include/opencv4/opencv2/imgcodecs.hpp ]
}

has_opencl_headers() {
    printf '#define CL_TARGET_OPENCL_VERSION 120\n#include <CL/cl.h>\n' | ${CC:-cc} -x c -fsyntax-only -
}

# A loader, and the driver for processors.
has_opencl_driver() {
    [ -e /etc/OpenCL/vendors/pocl.icd ] && /sbin/ldconfig -p | grep -q 'libOpenCL\.so\.1'
}

# What clang's sanitizers are linked with.
has_clang_runtime() {
    printf 'int main(void) { return 0; }\n' | clang -x c -fsanitize=memory -o /dev/null -
}

# A locale with a decimal comma, or the sources that one can be made from.
has_comma_locale() {
    [ -e /usr/share/i18n/locales/de_DE ] || locale -a | grep -qE '^(de_DE|fr_FR)'
}

# want "PACKAGE..." COMMAND...: the packages are missing unless the command works. What counts is what is there, not how it came.
want() {
    packages=$1
    shift
    "$@" > /dev/null 2>&1 || missing="$missing $packages"
}

look_for() {
    missing=
    want 'gcc libc6-dev' has_c
    want g++ has_cxx
    want meson meson --version
    want ninja-build ninja --version
    want pkg-config pkg-config --version
    want libpng-dev pkg-config --exists 'libpng >= 1.6.32'
    want libjpeg-dev pkg-config --exists 'libjpeg >= 2.0'
    want libwebp-dev pkg-config --exists 'libwebp >= 1.0'
    want libtiff-dev pkg-config --exists 'libtiff-4 >= 4.5'
    want libexif-dev pkg-config --exists 'libexif >= 0.6.22'
    want libopenjp2-7-dev pkg-config --exists 'libopenjp2 >= 2.3'
    want libheif-dev pkg-config --exists 'libheif >= 1.13'
    want libjansson-dev pkg-config --exists 'jansson >= 2.11'
    want libcairo2-dev pkg-config --exists 'cairo >= 1.16'
    want libopencv-imgcodecs-dev has_opencv
    for more in "$@"; do
        case $more in
        cmocka) want libcmocka-dev pkg-config --exists cmocka ;;
        clang)
            want clang clang --version
            want libclang-rt-dev has_clang_runtime
            ;;
        venv) want python3-venv python3 -c 'import venv, ensurepip' ;;
        opencl) want opencl-headers has_opencl_headers ;;
        pocl) want 'pocl-opencl-icd ocl-icd-libopencl1' has_opencl_driver ;;
        locale) want locales has_comma_locale ;;
        oclgrind) want oclgrind oclgrind --version ;;
        mandoc) want mandoc eval 'printf ".Dd 1 January 2026\n" | mandoc -T lint -W fatal' ;;
        esac
    done
}

cannot_install() {
    printf '%s: %s\n' "${0##*/}" "$1" >&2
    printf '%s: these packages are missing (names of Debian 12 and Ubuntu):\n   %s\n' "${0##*/}" "$missing" >&2
    printf '%s: install them, as root for instance with\n' "${0##*/}" >&2
    printf '    apt-get install --no-install-recommends%s\nand run this command again.\n' "$missing" >&2
    exit 3
}

# become_root: sets $as_root to what lets apt-get install.
become_root() {
    as_root=
    command -v apt-get > /dev/null || cannot_install 'there is no apt-get here'
    [ "$(id -u)" != 0 ] || return 0
    command -v sudo > /dev/null || cannot_install 'you are not root, and there is no sudo here'
    if [ -t 0 ]; then
        sudo -v || cannot_install 'sudo does not let you install packages'
    else
        sudo -n true 2> /dev/null || cannot_install 'sudo wants a password, and there is no terminal to ask for it'
    fi
    as_root=sudo
}

apt() {
    logged "apt-get-$1" $as_root env DEBIAN_FRONTEND=noninteractive PATH="$PATH:/usr/local/sbin:/usr/sbin:/sbin" \
        apt-get -q -o DPkg::Lock::Timeout=300 "$@"
}

# need [cmocka] [clang] [mandoc] [venv] [opencl] [pocl] [oclgrind] [locale]: installs what is missing for the build, and
# for these.
need() {
    mkdir -p "$logs" && [ -w "$logs" ] || fail "cannot write into $logs"
    look_for "$@"
    [ -n "$missing" ] || return 0
    become_root
    say "Installing with apt-get:$missing"
    apt update || say 'Going on with the package lists as they are.'
    apt install -y --no-install-recommends $missing || cannot_install 'apt-get failed'
    look_for "$@"
    [ -z "$missing" ] || cannot_install 'apt-get has installed packages, but they are not found'
}

# ---- build folders ----

# set_up FOLDER ARGUMENT...: meson setup, in the folder. Meson asks CMake about the system where it is called, in a subfolder of one
# name, so two at once would take it from each other.
set_up() {
    place=$1
    shift
    mkdir -p "$place" && (cd "$place" && meson setup "$@")
}

# configure FOLDER OPTION...: a build folder with these options. One that this script made with the same options and compilers is
# kept; one that somebody else made keeps the options not named here; one that cannot be used is made anew.
configure() {
    folder=$root/$1
    name=$1
    shift
    key="$root $* ${CC-} ${CXX-} ${CFLAGS-} ${CXXFLAGS-} ${LDFLAGS-} $(meson --version)"
    if [ -e "$folder/build.ninja" ] && [ "$(cat "$folder/.configured" 2> /dev/null)" = "$key" ]; then
        return 0
    fi
    if [ -e "$folder/build.ninja" ] && [ ! -e "$folder/.configured" ] &&
        set_up "$folder" --reconfigure "$folder" "$root" "$@" > "$logs/configure-$name.log" 2>&1; then
        return 0
    fi
    if [ -e "$folder" ] && [ ! -d "$folder/meson-private" ] && [ -n "$(ls -A "$folder")" ]; then
        fail "$folder is there and is no build folder of meson: move it away"
    fi
    rm -rf "$folder"
    logged "configure-$name" set_up "$folder" "$folder" "$root" "$@" || return 1
    printf '%s' "$key" > "$folder/.configured"
}
