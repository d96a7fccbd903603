/* Declared for std::filesystem::space, which then fails: files in memory have no limit to ask for. */
#pragma once

#include <errno.h>
#include <sys/types.h>

struct statvfs {
    unsigned long f_bsize, f_frsize, f_blocks, f_bfree, f_bavail;
};

static __inline__ int statvfs(const char* path, struct statvfs* status) {
    (void)path;
    (void)status;
    errno = ENOSYS;
    return -1;
}
