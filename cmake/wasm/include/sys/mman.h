/* Pages have one size. */
#pragma once

#include <stddef.h>

#define MADV_HUGEPAGE 14

static inline int madvise(void* begin, size_t size, int advice) {
    (void)begin;
    (void)size;
    (void)advice;
    return 0;
}
