/* SPDX-License-Identifier: BSD-2-Clause */
/* HEIF and AVIF through libheif, in a process of its own: heif_program.c. Below libheif are decoders of video, made for speed; the
 * sizes that they see stand deep in compressed data, where no probe gets. */
#include "decoder_process.h"

asj_status asj_heif_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                           const asj_message *message)
{
    return asj_decode_elsewhere("asj-io-heif", input, probe, max_pixels, buffer, message);
}
