/* SPDX-License-Identifier: BSD-2-Clause */
/* Operations by the forms that have them. Both return an exit status. */
#ifndef ASJ_TESTS_PARITY_MATRIX_H
#define ASJ_TESTS_PARITY_MATRIX_H

/* Prints a line for each operation of each table: which vector forms, and OpenCL, have one of their own. What src/simd/README.md
 * shows. */
int matrix_list(void);

/* Prints which checks (operations.h) run each operation; 1 when no check does. `sabotage`: the last check is left out. */
int matrix_coverage(int sabotage);

#endif
