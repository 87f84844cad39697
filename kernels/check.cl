/* SPDX-License-Identifier: BSD-2-Clause */
/* What the other kernels take for granted about arithmetic, in one number for each work-item (src/cl/check.c does the same). */
__kernel void check(__global uint *results)
{
    const uint i = (uint)get_global_id(0), a = i * 2654435761u + 12345u;
    const short s = (short)(a >> 16), t = (short)a;
    const ulong w = (ulong)a * 0x9e3779b97f4a7c15ul;
    uint sum = (uint)((int)a >> 5); /* keeps the sign */
    sum = sum * 31u + (uint)(int)mul_hi(s, t);
    sum = sum * 31u + (uint)mul_hi((ushort)s, (ushort)t) + (uint)abs(s);
    sum = sum * 31u + (uint)(w >> (a & 63u)) + (uint)clz(w | 1ul);
    sum = sum * 31u + (uint)select(s, t, (short)(s < t ? -1 : 0));
    /* rounded after the product, not only after the sum; towards zero as an integer */
    const uint m = a & 0xffffu, n = (a >> 8) & 0xffffu;
    const float left = (float)m * (float)n + -(float)(m * n & ~0xffu);
    sum = sum * 31u + (uint)convert_int(left) + (uint)convert_int((float)(int)t * 0.37f);
    results[i] = sum;
}
