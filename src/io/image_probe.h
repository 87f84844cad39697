/* SPDX-License-Identifier: BSD-2-Clause */
/* What the first bytes of an image file say, before any decoder is trusted with it. The kind found here, and nothing else, says
 * which decoder reads the file. */
#ifndef ASJ_IO_IMAGE_PROBE_H
#define ASJ_IO_IMAGE_PROBE_H

#include "probe.h"

void asj_probe_image(const asj_input *input, asj_image_probe *probe);

/* The kind by the signature, which stands in the first bytes. */
asj_image_kind asj_probe_kind(const asj_input *input);

#endif
