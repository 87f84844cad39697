/* SPDX-License-Identifier: BSD-2-Clause */
/* Statuses, stages and vector forms as words; the version. */
#include <asj/context.h>
#include <asj/status.h>
#include <asj/version.h>

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

const char *asj_status_string(asj_status status)
{
    switch (status) {
    case ASJ_OK: return "success";
    case ASJ_ERROR_ARGUMENT: return "invalid argument";
    case ASJ_ERROR_OPTION: return "invalid option";
    case ASJ_ERROR_IMAGE: return "invalid image";
    case ASJ_ERROR_LIMIT: return "limit exceeded";
    case ASJ_ERROR_MEMORY: return "out of memory";
    case ASJ_ERROR_CANCELLED: return "cancelled";
    case ASJ_ERROR_DEVICE: return "device not available or failed";
    case ASJ_ERROR_FILE: return "file cannot be read or written";
    case ASJ_ERROR_FORMAT: return "file content is damaged or of another kind";
    case ASJ_ERROR_UNSUPPORTED: return "not supported by this build";
    default: return "unknown status";
    }
}

const char *asj_stage_name(int32_t stage)
{
    static const char *const names[ASJ_STAGE_COUNT] = {"gradient", "candidates", "isotropic", "locate", "scan", "refine",
                                                       "decompose", "patches", "distances", "align", "assign"};
    return stage >= 0 && stage < ASJ_STAGE_COUNT ? names[stage] : "unknown";
}

const char *asj_simd_name(int32_t simd)
{
    static const char *const names[ASJ_SIMD_COUNT] = {"auto", "reference", "sse2", "avx2", "avx512", "neon", "vectors"};
    return simd >= 0 && simd < ASJ_SIMD_COUNT ? names[simd] : "unknown";
}

uint32_t asj_version(void)
{
    return ASJ_VERSION;
}

const char *asj_version_string(void)
{
    return TEXT(ASJ_VERSION_MAJOR) "." TEXT(ASJ_VERSION_MINOR) "." TEXT(ASJ_VERSION_PATCH);
}
