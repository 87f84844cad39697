# SPDX-License-Identifier: BSD-2-Clause
# Runs a program on Oclgrind, which simulates a device and reports accesses out of bounds, races and wrong calls:
# sh simulator.sh DRIVER PROGRAM [ARGUMENT...]. Fails when it reports anything. (Its check of uninitialised values stops at the
# instruction `freeze`, which the compiler of Debian 12 makes.)
set -u
driver=$1
shift
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/vendors" "$folder/tmp"
echo "$driver" > "$folder/vendors/oclgrind.icd"
OCL_ICD_VENDORS=$folder/vendors TMPDIR=$folder/tmp OCLGRIND_LOG=$folder/report OCLGRIND_CHECK_API=1 OCLGRIND_DATA_RACES=1 \
    OCLGRIND_MAX_ERRORS=20 OCLGRIND_LOCAL_MEM_SIZE=1048576 "$@"
state=$?
if [ -s "$folder/report" ]; then
    cat "$folder/report"
    exit 1
fi
exit $state
