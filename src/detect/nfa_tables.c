/* SPDX-License-Identifier: BSD-2-Clause */
/* Nodes and weights of Gauss-Legendre quadrature, 16 points (Abramowitz and Stegun, table 25.4); the other half mirrors them. */
#include "nfa_tables.h"

const double asj_nfa_gauss_node[ASJ_NFA_GAUSS] = {
    0.095012509837637441, 0.28160355077925892, 0.45801677765722737, 0.61787624440264377,
    0.755404408355003,    0.86563120238783176, 0.9445750230732326,  0.98940093499164994};
const double asj_nfa_gauss_weight[ASJ_NFA_GAUSS] = {
    0.18945061045506864, 0.18260341504492364,  0.16915651939500265,  0.14959598881657671,
    0.12462897125553407, 0.095158511682492605, 0.062253523938647456, 0.027152459411754176};
