/* SPDX-License-Identifier: BSD-2-Clause */
/* What a decoder in a process of its own is given of the process that starts it. The program stands beside this one. */
#define _XOPEN_SOURCE 700
#include "decoder_process.h"
#include "image_buffer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

enum { DESCRIPTORS = 64, OPEN_HERE = 40 }; /* as decoder_spy.c has it; one that every program would inherit */

static unsigned char *ask(const char *program)
{
    const asj_image_probe probe = {.kind = ASJ_KIND_BMP, .name = "BMP", .width = DESCRIPTORS, .height = 1, .has_size = 1};
    char text[512] = "";
    const asj_message message = asj_message_start(text, sizeof text, "picture");
    asj_image_buffer buffer = {0};
    unsigned char file[4096] = {0};
    const asj_input input = {file, sizeof file};
    const asj_status status = asj_decode_elsewhere(program, &input, &probe, DESCRIPTORS, &buffer, &message);
    if (status != ASJ_OK)
        fail_msg("%s", text);
    assert_int_equal(buffer.width, DESCRIPTORS);
    return buffer.pixels;
}

static void no_file_is_open_there_but_three(void **state)
{
    (void)state;
    assert_int_equal(dup2(STDIN_FILENO, OPEN_HERE), OPEN_HERE);
    unsigned char *pixels = ask("decoder-spy");
    close(OPEN_HERE);
    for (int descriptor = 0; descriptor < DESCRIPTORS; descriptor++)
        if (pixels[descriptor] != (descriptor > 2 ? 255 : 0))
            fail_msg("descriptor %d is %s", descriptor, pixels[descriptor] ? "closed" : "open");
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_file_is_open_there_but_three)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
