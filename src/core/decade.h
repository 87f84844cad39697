/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers of false alarms are kept as natural logarithms and told as decimal ones. */
#ifndef ASJ_SRC_DECADE_H
#define ASJ_SRC_DECADE_H

#define ASJ_LN_10 2.302585092994046 /* log(10), to the bit */

#endif
