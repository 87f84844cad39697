/* SPDX-License-Identifier: BSD-2-Clause */
/* OpenCL drivers initialise themselves at the first calls, and not all of them safely when threads call at once: PoCL 3.1 crashes
 * when threads ask for its devices together. So everything up to a command queue is behind one lock of the
 * process, the only state outside a context. No callback of the caller but the allocator runs while it is held. */
#ifndef ASJ_SRC_CL_STARTUP_H
#define ASJ_SRC_CL_STARTUP_H

void asj_cl_startup_begin(void);
void asj_cl_startup_end(void);

#endif
