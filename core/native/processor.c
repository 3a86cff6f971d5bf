/* Which code path this processor can run: own cpuid, because zig's __builtin_cpu_supports says no
 * to everything. */
#include "kernel.h"

#if defined(__x86_64__)
#include <cpuid.h>

static uint64_t enabled_state(void) {
    uint32_t low, high;
    __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0)); /* xgetbv */
    return (uint64_t)high << 32 | low;
}

#define HAS(word, bits) (((word) & (bits)) == (bits))

int32_t sm_processor(void) {
    uint32_t a, b, c, d, extended;
    if (!__get_cpuid(1, &a, &b, &c, &d)) return 1;
    if (!HAS(c, bit_FMA | bit_SSE4_2 | bit_POPCNT | bit_MOVBE | bit_OSXSAVE | bit_AVX | bit_F16C)) return 1;
    uint64_t state = enabled_state();
    if (!HAS(state, 0x06)) return 1; /* the system saves xmm and ymm registers */
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || !HAS(b, bit_AVX2 | bit_BMI | bit_BMI2)) return 1;
    uint32_t features = b;
    if (!__get_cpuid(0x80000001u, &a, &b, &extended, &d) || !HAS(extended, bit_LZCNT)) return 1;
    uint32_t wanted = bit_AVX512F | bit_AVX512DQ | bit_AVX512CD | bit_AVX512BW | bit_AVX512VL;
    return HAS(state, 0xe6) && HAS(features, wanted) ? 4 : 3; /* zmm and mask registers */
}
#else
int32_t sm_processor(void) { return 1; }
#endif
