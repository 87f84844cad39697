# SPDX-License-Identifier: BSD-2-Clause
# The core on 64-bit ARM: built by a cross compiler, its tests run under qemu-user. Sourced by test.sh. What is missing here is
# left out with a line that says so; nothing is installed but two packages of tools, and CMocka for ARM is only unpacked.

arm=$root/out/arm64
arm_packages='gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user'

arm_tools() {
    command -v aarch64-linux-gnu-gcc > /dev/null && command -v qemu-aarch64 > /dev/null
}

# In a subshell, as become_root ends the script where it fails.
arm_install() {
    arm_tools || (become_root && apt install -y --no-install-recommends $arm_packages) > /dev/null 2>&1
    arm_tools
}

arm_apt() {
    logged "arm-apt-$1" apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User= \
        -o "Dir::State=$arm/apt/state" -o "Dir::State::status=$arm/apt/status" -o "Dir::Cache=$arm/apt/cache" "$@"
}

arm_has_cmocka() {
    [ -e "$arm/usr/lib/aarch64-linux-gnu/pkgconfig/cmocka.pc" ]
}

# With lists and states of its own, so that the system does not hear of another architecture.
arm_unpack_cmocka() {
    mkdir -p "$arm/apt/state/lists/partial" "$arm/apt/cache/archives/partial" && : > "$arm/apt/status" && cd "$arm/apt" &&
        arm_apt update && arm_apt download libcmocka-dev libcmocka0 || return 1
    for package in ./*.deb; do
        dpkg -x "$package" "$arm" || return 1
    done
}

arm_cross_file() {
    cat << END
[binaries]
c = 'aarch64-linux-gnu-gcc'
ar = 'aarch64-linux-gnu-ar'
strip = 'aarch64-linux-gnu-strip'
pkgconfig = 'pkg-config'
exe_wrapper = ['qemu-aarch64', '-L', '/usr/aarch64-linux-gnu', '-E', 'LD_LIBRARY_PATH=$arm/usr/lib/aarch64-linux-gnu']

[properties]
sys_root = '$arm'
pkg_config_libdir = '$arm/usr/lib/aarch64-linux-gnu/pkgconfig'
needs_exe_wrapper = true

[host_machine]
system = 'linux'
cpu_family = 'aarch64'
cpu = 'armv8-a'
endian = 'little'
END
}

# Parity runs the vector forms of all operations. Of the unit tests some that reach them or threads; under emulation the others
# would take as long again.
arm_units='memory context image gradient field isotropic locate strip stages patch align'

on_aarch64() {
    if ! arm_install; then
        say "skipped: aarch64 ($arm_packages: not here, and not to be installed)"
        skipped=$((skipped + 1))
        return 0
    fi
    mkdir -p "$arm"
    arm_cross_file > "$arm/cross.ini"
    arm_has_cmocka || (arm_unpack_cmocka) > /dev/null 2>&1
    wanted='parity parity-list detection-parity'
    targets='tests/parity/parity tests/parity/detection-parity'
    if arm_has_cmocka; then
        for unit in $arm_units; do
            wanted="$wanted $unit"
            targets="$targets tests/unit/test_$unit"
        done
    else
        say 'skipped: aarch64: unit tests (no CMocka for arm64 from apt-get)'
        skipped=$((skipped + 1))
    fi
    say
    say 'Building in build-aarch64/'
    configure build-aarch64 --cross-file "$arm/cross.ini" -Dio=disabled -Dopencv=disabled -Dcairo=disabled -Dcli=disabled \
        -Dopencl=disabled -Dthreads=enabled -Dsimd=enabled -Dtests=auto --werror &&
        logged build-build-aarch64 ninja -C "$folder" $targets && run_tests build-aarch64 $wanted --timeout-multiplier 12
}
