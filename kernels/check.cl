/* SPDX-License-Identifier: BSD-2-Clause */
__kernel void check(__global uint *numbers, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i < count)
        numbers[i] = numbers[i] * 2654435761u + i;
}
