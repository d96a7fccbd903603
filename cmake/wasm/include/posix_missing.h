/* What Debian's C library for WASI (of 2022) lacks. Files in memory have no rights, owners or locks: what sets them does
   nothing; what asks for the system fails with ENOSYS. */
#pragma once

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef DT_SOCK
#define DT_SOCK (DT_UNKNOWN + 20)
#endif
#ifndef LOCK_EX
#define LOCK_EX 2
#define LOCK_NB 4
#endif
#ifndef SIG_UNBLOCK
#define SIG_BLOCK 0
#define SIG_UNBLOCK 1
#define SIG_SETMASK 2
#endif
#define TIOCGWINSZ 0x5413
#define STATX_TYPE 0x1
#define STATX_INO 0x100
#define STATX_BTIME 0x800

struct winsize {
    unsigned short ws_row, ws_col, ws_xpixel, ws_ypixel;
};
struct statx_timestamp {
    long long tv_sec;
    unsigned tv_nsec;
};
struct statx {
    unsigned stx_mask, stx_dev_major, stx_dev_minor;
    unsigned short stx_mode;
    unsigned long long stx_ino;
    struct statx_timestamp stx_btime;
};

int fchmod(int file, mode_t mode);
int chmod(const char* path, mode_t mode);
int fchmodat(int folder, const char* path, mode_t mode, int flags);
int fchown(int file, uid_t user, gid_t group);
mode_t umask(mode_t mask);
int flock(int file, int operation);
int dup(int file);
char* realpath(const char* path, char* result);
int mkstemp(char* pattern);
char* mkdtemp(char* pattern);
int statx(int folder, const char* path, int flags, unsigned mask, struct statx* status);
uid_t getuid(void);
uid_t geteuid(void);
gid_t getgid(void);
gid_t getegid(void);
pid_t getpid(void);
int pthread_sigmask(int how, const sigset_t* set, sigset_t* before);
int sigemptyset(sigset_t* set);
int sigaddset(sigset_t* set, int signal);

#ifdef __cplusplus
}
#endif
