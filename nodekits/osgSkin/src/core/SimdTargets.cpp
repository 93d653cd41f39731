// SPDX-License-Identifier: MIT
//
// Highway is used by its headers alone. Its library, which chooses the instruction set, calibrates
// a timer whenever it is loaded: some milliseconds in every process that is linked with it. So what
// the headers need of it is here, and not exported.
#include "core/SimdTargets.h"

#include <hwy/highway.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

namespace {

#if HWY_ARCH_X86
/// The feature words that instruction sets are named in: Intel's manual, CPUID.
struct Features {
    unsigned int ecx1 = 0, ebx7 = 0, ecx7 = 0, ecxExtended = 0;

    Features() {
        unsigned int eax, ebx, ecx, edx;
        if (__get_cpuid(1, &eax, &ebx, &ecx, &edx)) ecx1 = ecx;
        if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx)) ebx7 = ebx, ecx7 = ecx;
        if (__get_cpuid(0x80000001u, &eax, &ebx, &ecx, &edx)) ecxExtended = ecx;
    }
};

constexpr unsigned int bits(std::initializer_list<unsigned int> numbers) {
    unsigned int word = 0;
    for (const unsigned int number : numbers) word |= 1u << number;
    return word;
}

bool has(unsigned int word, unsigned int all) {
    return (word & all) == all;
}
#endif

std::int64_t findTargets() {
    std::int64_t targets = HWY_STATIC_TARGET;
#if HWY_ARCH_X86
    const Features cpu;
    __builtin_cpu_init();
    if (!has(cpu.ecx1, bits({9}))) return targets; // SSSE3
    targets |= HWY_SSSE3;
    if (!has(cpu.ecx1, bits({1, 19, 20, 25}))) return targets; // PCLMUL, SSE4.1, SSE4.2, AES
    targets |= HWY_SSE4;
    // FMA, F16C; BMI1, AVX2, BMI2; LZCNT. The system must keep the wide registers, too.
    if (!has(cpu.ecx1, bits({12, 29})) || !has(cpu.ebx7, bits({3, 5, 8})) ||
        !has(cpu.ecxExtended, bits({5})) || !__builtin_cpu_supports("avx2"))
        return targets;
    targets |= HWY_AVX2;
    // AVX-512 F, DQ, CD, BW, VL
    if (!has(cpu.ebx7, bits({16, 17, 28, 30, 31})) || !__builtin_cpu_supports("avx512f"))
        return targets;
    targets |= HWY_AVX3;
    // VBMI, VBMI2, GFNI, VAES, VPCLMULQDQ, VNNI, BITALG, VPOPCNTDQ
    if (has(cpu.ecx7, bits({1, 6, 8, 9, 10, 11, 12, 14}))) targets |= HWY_AVX3_DL;
#endif
    return targets;
}

std::int64_t foundTargets() {
    static const std::int64_t found = findTargets();
    return found;
}

std::int64_t allowed = 0; ///< by setSimdTargets()

} // namespace

namespace hwy {

int64_t SupportedTargets() {
    return allowed != 0 ? allowed : foundTargets();
}

ChosenTarget& GetChosenTarget() {
    static ChosenTarget chosen;
    return chosen;
}

/// Of failed assertions, in debug builds.
HWY_NORETURN void Abort(const char* file, int line, const char* format, ...) {
    std::fprintf(stderr, "osgSkin: %s:%d: ", file, line);
    std::va_list arguments;
    va_start(arguments, format);
    std::vfprintf(stderr, format, arguments);
    va_end(arguments);
    std::abort();
}

} // namespace hwy

namespace osgSkin {

std::int64_t simdTargets() {
    return foundTargets();
}

void setSimdTargets(std::int64_t targets) {
    allowed = targets;
    hwy::GetChosenTarget().DeInit(); // the next call of a kernel chooses
}

} // namespace osgSkin
