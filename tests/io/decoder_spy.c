/* SPDX-License-Identifier: BSD-2-Clause */
/* In place of a decoder: answers with one pixel for each descriptor, black where it is open. */
#include "decoder_answer.h"

#include <fcntl.h>
#include <stdio.h>

enum { DESCRIPTORS = 64 };

int main(void)
{
    const asj_decoder_answer answer = {ASJ_DECODER_MAGIC, ASJ_DECODER_GRAY8, DESCRIPTORS, 1};
    while (getchar() != EOF)
        continue;
    fwrite(&answer, sizeof answer, 1, stdout);
    for (int descriptor = 0; descriptor < DESCRIPTORS; descriptor++)
        putchar(fcntl(descriptor, F_GETFD) < 0 ? 255 : 0);
    return fflush(stdout) != 0;
}
