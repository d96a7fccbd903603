/* Functions of include/posix_missing.h and the keys of include/pthread.h. */
#include "posix_missing.h"

#include <fcntl.h>
#include <limits.h>
#include <pthread.h>

enum { max_keys = 64 };
static const void* key_values[max_keys];
static unsigned keys = 0;

int pthread_key_create(pthread_key_t* key, void (*destructor)(void*)) {
    (void)destructor; /* the thread ends with the program */
    if (keys >= max_keys) return EAGAIN;
    *key = keys++;
    return 0;
}
int pthread_key_delete(pthread_key_t key) {
    (void)key;
    return 0;
}
void* pthread_getspecific(pthread_key_t key) { return (void*)key_values[key]; }
int pthread_setspecific(pthread_key_t key, const void* value) {
    key_values[key] = value;
    return 0;
}

extern int __cxa_atexit(void (*)(void*), void*, void*);
int __cxa_thread_atexit(void (*destructor)(void*), void* object, void* library) {
    return __cxa_atexit(destructor, object, library);
}

int fchmod(int file, mode_t mode) {
    (void)file;
    (void)mode;
    return 0;
}
int chmod(const char* path, mode_t mode) {
    (void)path;
    (void)mode;
    return 0;
}
int fchmodat(int folder, const char* path, mode_t mode, int flags) {
    (void)folder;
    (void)path;
    (void)mode;
    (void)flags;
    return 0;
}
int fchown(int file, uid_t user, gid_t group) {
    (void)file;
    (void)user;
    (void)group;
    return 0;
}
mode_t umask(mode_t mask) {
    (void)mask;
    return 022;
}
int flock(int file, int operation) {
    (void)file;
    (void)operation;
    return 0;
}
int dup(int file) {
    (void)file;
    errno = ENOSYS;
    return -1;
}
uid_t getuid(void) { return 0; }
uid_t geteuid(void) { return 0; }
gid_t getgid(void) { return 0; }
gid_t getegid(void) { return 0; }
int pthread_sigmask(int how, const sigset_t* set, sigset_t* before) {
    (void)how;
    (void)set;
    (void)before;
    return 0;
}
int sigemptyset(sigset_t* set) {
    memset(set, 0, sizeof *set);
    return 0;
}
int sigaddset(sigset_t* set, int signal) {
    (void)set;
    (void)signal;
    return 0;
}

/* There are no links: the path from the root without "." and "..". */
char* realpath(const char* path, char* result) {
    struct stat status;
    if (stat(path, &status) != 0) return 0;
    char full[PATH_MAX];
    char folder[PATH_MAX];
    if (path[0] != '/' && !getcwd(folder, sizeof folder)) return 0;
    if (snprintf(full, sizeof full, "%s/%s", path[0] == '/' ? "" : folder, path) >= (int)sizeof full) {
        errno = ENAMETOOLONG;
        return 0;
    }
    char* out = result ? result : malloc(PATH_MAX);
    size_t used = 0;
    char* rest = 0;
    for (char* part = strtok_r(full, "/", &rest); part; part = strtok_r(0, "/", &rest)) {
        if (!strcmp(part, ".")) continue;
        if (!strcmp(part, "..")) {
            while (used > 0 && out[--used] != '/') {}
            continue;
        }
        used += (size_t)sprintf(out + used, "/%s", part);
    }
    if (used == 0) out[used++] = '/';
    out[used] = 0;
    return out;
}

/* The next name of a pattern that ends in XXXXXX. */
static int next_name(char* pattern) {
    static unsigned count = 0;
    const size_t length = strlen(pattern);
    if (length < 6) {
        errno = EINVAL;
        return 0;
    }
    sprintf(pattern + length - 6, "%06u", ++count % 1000000U);
    return 1;
}

int mkstemp(char* pattern) {
    while (next_name(pattern)) {
        const int file = open(pattern, O_RDWR | O_CREAT | O_EXCL, 0600);
        if (file >= 0 || errno != EEXIST) return file;
    }
    return -1;
}

char* mkdtemp(char* pattern) {
    while (next_name(pattern)) {
        if (mkdir(pattern, 0700) == 0) return pattern;
        if (errno != EEXIST) return 0;
    }
    return 0;
}

int statx(int folder, const char* path, int flags, unsigned mask, struct statx* result) {
    (void)folder; /* paths of the program are its own */
    (void)flags;
    struct stat status;
    if (stat(path, &status) != 0) return -1;
    memset(result, 0, sizeof *result);
    result->stx_mask = mask & ~(unsigned)STATX_BTIME;
    result->stx_dev_major = (unsigned)status.st_dev;
    result->stx_mode = (unsigned short)status.st_mode;
    result->stx_ino = status.st_ino;
    return 0;
}
