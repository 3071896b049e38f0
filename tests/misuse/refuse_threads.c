/* SPDX-License-Identifier: Apache-2.0 */
/* Preloaded (LD_PRELOAD), this library lets a process start at most OVC_TEST_THREADS threads. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>

typedef int (*create_function)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*), void* argument) {
    static int started;
    create_function create;
    const char* most = getenv("OVC_TEST_THREADS");
    if (most && __atomic_fetch_add(&started, 1, __ATOMIC_SEQ_CST) >= atoi(most))
        return EAGAIN;
    *(void**)&create = dlsym(RTLD_NEXT, "pthread_create");
    return create(thread, attributes, body, argument);
}
