/* SPDX-License-Identifier: BSD-2-Clause */
/* Tails of sums of gamma as the isotropic test reads them: logarithms and error functions by the thousand. */
#include "nfa_fill.h"

void asj_nfa_fill_tails(asj_nfa *nfa)
{
    double *tail = nfa->tails;
    for (int32_t n = 1; n <= ASJ_NFA_TAIL_TERMS; n++)
        for (int32_t i = 0; i < asj_nfa_tail_length(n); i++)
            *tail++ = asj_nfa_log_sector_tail(nfa, (double)i / ASJ_TAIL_STEPS, n);
}
