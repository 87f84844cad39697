/* SPDX-License-Identifier: BSD-2-Clause */
/* BMP, Sun raster and Radiance HDR through OpenCV's imgcodecs, in a process of its own: opencv_program.cpp. OpenCV chooses among
 * its decoders by itself, so only signatures that belong to one of its own decoders get there. */
#include "decoder_process.h"

#include <string.h>

asj_status asj_opencv_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                             const asj_message *message)
{
    if (input->size >= 132 && !memcmp(input->bytes + 128, "DICM", 4)) /* OpenCV could take it for a medical image */
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "a %s that is marked as DICOM is not read", probe->name);
    return asj_decode_elsewhere("asj-io-opencv", input, probe, max_pixels, buffer, message);
}
