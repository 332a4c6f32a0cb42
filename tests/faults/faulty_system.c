// A library for LD_PRELOAD with faults of the operating system, for tests. It maps the file that SPHERULE_FAULTY_SYSTEM
// names: two signed 64-bit numbers, which a test changes while the program runs (tests/support/py/faults.py).
// - The first one: seconds that are added to the wall clock. The steady clock stays right.
// - The second one, unless 0: the disk is full. Every other write to a regular file stores half of its bytes, as the
//   last write that finds room does. The writes in between fail with ENOSPC.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum { NANOSECONDS_PER_MICROSECOND = 1000 };

typedef struct {
    int64_t clockOffset;
    int64_t full;
} Faults;

static const Faults none;
static const volatile Faults* faults = &none;
static int (*rightClock)(clockid_t, struct timespec*);

__attribute__((constructor)) static void begin(void) {
    rightClock = (int (*)(clockid_t, struct timespec*))dlsym(RTLD_NEXT, "clock_gettime");
    const char* const path = getenv("SPHERULE_FAULTY_SYSTEM");
    const int file = path == NULL ? -1 : open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    void* const map = mmap(NULL, sizeof(Faults), PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (map != MAP_FAILED) faults = map;
}

// Returns how many bytes of a write find room; -1: none.
static ssize_t roomFor(int file, size_t size) {
    static unsigned writes;
    struct stat found;
    if (!faults->full || fstat(file, &found) != 0 || !S_ISREG(found.st_mode)) return (ssize_t)size;
    if (size < 2 || __atomic_fetch_add(&writes, 1, __ATOMIC_RELAXED) % 2 != 0) {
        errno = ENOSPC;
        return -1;
    }
    return (ssize_t)(size / 2);
}

ssize_t write(int file, const void* bytes, size_t size) {
    const ssize_t room = roomFor(file, size);
    return room < 0 ? -1 : syscall(SYS_write, file, bytes, room);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t place) {
    const ssize_t room = roomFor(file, size);
    return room < 0 ? -1 : syscall(SYS_pwrite64, file, bytes, room, place);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t place) {
    return pwrite(file, bytes, size, place);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
    return roomFor(file, 1) < 0 ? -1 : syscall(SYS_writev, file, parts, count);
}

int clock_gettime(clockid_t clock, struct timespec* now) {
    const int result = rightClock == NULL ? (int)syscall(SYS_clock_gettime, clock, now) : rightClock(clock, now);
    if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) now->tv_sec += faults->clockOffset;
    return result;
}

int gettimeofday(struct timeval* now, void* zone) {
    (void)zone;
    struct timespec exact;
    clock_gettime(CLOCK_REALTIME, &exact);
    now->tv_sec = exact.tv_sec;
    now->tv_usec = exact.tv_nsec / NANOSECONDS_PER_MICROSECOND;
    return 0;
}

time_t time(time_t* now) {
    struct timespec exact;
    clock_gettime(CLOCK_REALTIME, &exact);
    if (now != NULL) *now = exact.tv_sec;
    return exact.tv_sec;
}
