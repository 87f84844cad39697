/* SPDX-License-Identifier: BSD-2-Clause */
/* A program of the build: writes asj_nfa_stored (nfa_tables.h) as C, to the last bit. */
#include "nfa_fill.h"

#include <stdio.h>

static void print(const char *name, const double *values, size_t count)
{
    printf("    .%s = {", name);
    for (size_t i = 0; i < count; i++)
        printf("%s%a,", i % 8 ? " " : "\n        ", values[i]);
    printf("\n    },\n");
}

int main(void)
{
    static asj_nfa nfa;
    char name[32];
    asj_nfa_fill_sector(&nfa);
    asj_nfa_fill_arc(&nfa);
    asj_nfa_fill_tails(&nfa);
    printf("/* Written by nfa_store.c. */\n#include \"detect/nfa_tables.h\"\n\nconst asj_nfa asj_nfa_stored = {\n    .rate = {\n");
    for (int i = 0; i <= ASJ_NFA_RATE_CELLS; i++)
        printf("        {%a, %a, %a, %a},\n", nfa.rate[i].root, nfa.rate[i].root_slope, nfa.rate[i].correction,
               nfa.rate[i].correction_slope);
    printf("    },\n");
    for (int n = 1; n <= ASJ_NFA_DIRECT; n++) {
        snprintf(name, sizeof name, "sector[%d]", n);
        print(name, nfa.sector[n], ASJ_NFA_SECTOR_CELLS + 1);
    }
    for (int n = 1; n <= ASJ_MAX_ARC; n++) {
        snprintf(name, sizeof name, "arc[%d]", n);
        print(name, nfa.arc[n], ASJ_NFA_ARC_CELLS + 1);
    }
    print("tails", nfa.tails, ASJ_NFA_TAILS);
    printf("};\n");
    return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
