// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program, makes reads and writes of regular files fail as a disk might.
// OVC_FAULT=KIND:CALL:N, such as eio:pread:12, is the N-th of such calls, from 1 on; kinds are eio,
// enospc, short (half of the bytes), eintr and none. eio and enospc stay from then on; the others
// come every N calls. A mapping that fails is made, and fails when it is touched, as it does where
// the disk can read no more. OVC_FAULT_FOLDER: files elsewhere are left alone.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static atomic_long calls;

static int is_watched(int file) {
    const char* folder = getenv("OVC_FAULT_FOLDER");
    char link[64], path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t size = readlink(link, path, sizeof path - 1);
    return folder && size > 0 && strncmp(path, folder, strlen(folder)) == 0;
}

/* Returns the bytes that a call may move, or -1 with errno set. */
static ssize_t allowed(const char* call, int file, size_t size) {
    char kind[16], which[16];
    long n;
    const char* fault = getenv("OVC_FAULT");
    if (!fault || sscanf(fault, "%15[^:]:%15[^:]:%ld", kind, which, &n) != 3 ||
        strcmp(which, call) != 0 || !is_watched(file))
        return (ssize_t)size;
    const long now = atomic_fetch_add(&calls, 1) + 1;
    if (strcmp(kind, "eio") == 0 || strcmp(kind, "enospc") == 0) {
        if (now < n)
            return (ssize_t)size;
        errno = kind[1] == 'i' ? EIO : ENOSPC;
        return -1;
    }
    if (now % n != 0 || size < 2)
        return (ssize_t)size;
    if (strcmp(kind, "eintr") == 0) {
        errno = EINTR;
        return -1;
    }
    return (ssize_t)(strcmp(kind, "short") == 0 ? size / 2 : size);
}

#define NEXT(name) (__extension__(__typeof__(&name)) dlsym(RTLD_NEXT, #name))

ssize_t read(int file, void* to, size_t size) {
    const ssize_t now = allowed("read", file, size);
    return now < 0 ? now : NEXT(read)(file, to, (size_t)now);
}

ssize_t write(int file, const void* from, size_t size) {
    const ssize_t now = allowed("write", file, size);
    return now < 0 ? now : NEXT(write)(file, from, (size_t)now);
}

int fsync(int file) {
    return allowed("fsync", file, 1) < 0 ? -1 : NEXT(fsync)(file);
}

ssize_t pread64(int file, void* to, size_t size, off64_t at) {
    const ssize_t now = allowed("pread", file, size);
    return now < 0 ? now : NEXT(pread64)(file, to, (size_t)now, at);
}

ssize_t pread(int file, void* to, size_t size, off_t at) {
    return pread64(file, to, size, at);
}

ssize_t pwrite64(int file, const void* from, size_t size, off64_t at) {
    const ssize_t now = allowed("pwrite", file, size);
    return now < 0 ? now : NEXT(pwrite64)(file, from, (size_t)now, at);
}

ssize_t pwrite(int file, const void* from, size_t size, off_t at) {
    return pwrite64(file, from, size, at);
}

/* Where it is to fail, it maps what lies far behind the file's end. */
void* mmap64(void* at, size_t size, int may, int flags, int file, off64_t offset) {
    const off64_t far = file >= 0 && allowed("mmap", file, size) < 0 ? (off64_t)1 << 40 : 0;
    return NEXT(mmap64)(at, size, may, flags, file, offset + far);
}

void* mmap(void* at, size_t size, int may, int flags, int file, off_t offset) {
    return mmap64(at, size, may, flags, file, offset);
}
