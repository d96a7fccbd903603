/* POSIX threads of a module that has one thread. A new thread is run to its end where it is made: loops over threads work
   unchanged, and waiting for another thread would never end, so that it aborts. */
#pragma once

#define __NEED_pthread_t
#define __NEED_pthread_once_t
#define __NEED_pthread_key_t
#define __NEED_pthread_mutex_t
#define __NEED_pthread_mutexattr_t
#define __NEED_pthread_cond_t
#define __NEED_pthread_condattr_t
#define __NEED_pthread_attr_t
#define __NEED_pthread_rwlock_t
#include <bits/alltypes.h>
#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PTHREAD_MUTEX_INITIALIZER {{{0}}}
#define PTHREAD_COND_INITIALIZER {{{0}}}
#define PTHREAD_ONCE_INIT 0
#define PTHREAD_MUTEX_NORMAL 0
#define PTHREAD_MUTEX_RECURSIVE 1
#define ONE_THREAD static __inline__ __attribute__((__unused__))

ONE_THREAD int pthread_mutexattr_init(pthread_mutexattr_t* attributes) {
    attributes->__attr = 0;
    return 0;
}
ONE_THREAD int pthread_mutexattr_settype(pthread_mutexattr_t* attributes, int type) {
    attributes->__attr = (unsigned)type;
    return 0;
}
ONE_THREAD int pthread_mutexattr_destroy(pthread_mutexattr_t* attributes) {
    (void)attributes;
    return 0;
}
ONE_THREAD int pthread_mutex_init(pthread_mutex_t* mutex, const pthread_mutexattr_t* attributes) {
    (void)attributes;
    mutex->__u.__i[0] = 0;
    return 0;
}
ONE_THREAD int pthread_mutex_lock(pthread_mutex_t* mutex) {
    ++mutex->__u.__i[0];
    return 0;
}
ONE_THREAD int pthread_mutex_trylock(pthread_mutex_t* mutex) {
    if (mutex->__u.__i[0]) return EBUSY;
    ++mutex->__u.__i[0];
    return 0;
}
ONE_THREAD int pthread_mutex_unlock(pthread_mutex_t* mutex) {
    --mutex->__u.__i[0];
    return 0;
}
ONE_THREAD int pthread_mutex_destroy(pthread_mutex_t* mutex) {
    (void)mutex;
    return 0;
}
ONE_THREAD int pthread_cond_signal(pthread_cond_t* condition) {
    (void)condition;
    return 0;
}
ONE_THREAD int pthread_cond_broadcast(pthread_cond_t* condition) {
    (void)condition;
    return 0;
}
ONE_THREAD int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
    (void)condition;
    (void)mutex;
    abort();
}
ONE_THREAD int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const struct timespec* until) {
    (void)condition;
    (void)mutex;
    (void)until;
    return ETIMEDOUT;
}
ONE_THREAD int pthread_cond_destroy(pthread_cond_t* condition) {
    (void)condition;
    return 0;
}
ONE_THREAD int pthread_once(pthread_once_t* once, void (*function)(void)) {
    if (!*once) {
        *once = 1;
        function();
    }
    return 0;
}
ONE_THREAD pthread_t pthread_self(void) { return (pthread_t)1; }
ONE_THREAD int pthread_equal(pthread_t one, pthread_t other) { return one == other; }
ONE_THREAD int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
                              void* argument) {
    (void)attributes;
    *thread = (pthread_t)2;
    function(argument);
    return 0;
}
ONE_THREAD int pthread_join(pthread_t thread, void** result) {
    (void)thread;
    if (result) *result = 0;
    return 0;
}
ONE_THREAD int pthread_detach(pthread_t thread) {
    (void)thread;
    return 0;
}
/* Of cmake/wasm/posix_missing.c. */
int pthread_key_create(pthread_key_t* key, void (*destructor)(void*));
int pthread_key_delete(pthread_key_t key);
void* pthread_getspecific(pthread_key_t key);
int pthread_setspecific(pthread_key_t key, const void* value);

#ifdef __cplusplus
}
#endif
