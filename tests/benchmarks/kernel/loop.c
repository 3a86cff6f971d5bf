/* Mutates what has led to new paths through the kernel, as counted where the compiler calls back.
 *
 *     fuzz SECONDS SEED FOLDER     fuzz, with a corpus that is read from and added to FOLDER; the case at
 *                                  which the process ends lies in FOLDER/running, behind its size
 *     fuzz FILE ...                run these cases once
 */
#include "fuzz.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

enum { MOST_BYTES = 1200, MOST_INPUTS = 20000, PLACES = 1 << 20, REPORT_SECONDS = 30 };

typedef struct {
    uint64_t size;
    uint8_t data[MOST_BYTES];
} input;

static uint8_t counters[PLACES], seen[PLACES];
static input *corpus[MOST_INPUTS], *current;
static size_t inputs;
static const char *folder;
static uint64_t state;

extern const char __executable_start;

void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void) {
    size_t place = (size_t)((const char *)__builtin_return_address(0) - &__executable_start) % PLACES;
    counters[place] = (uint8_t)(counters[place] + (counters[place] < 255));
}

static uint32_t draw(uint32_t n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (uint32_t)(state >> 33) % n;
}

/* The case that runs lies in a file, so that it outlives whatever becomes of the process. */
static void share_current(void) {
    char name[4096];
    snprintf(name, sizeof name, "%s/running", folder);
    int file = open(name, O_RDWR | O_CREAT, 0644);
    if (file < 0 || ftruncate(file, sizeof *current)) abort();
    current = mmap(0, sizeof *current, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (current == MAP_FAILED) abort();
}

static void save(const input *in, size_t number) {
    char name[4096];
    snprintf(name, sizeof name, "%s/input-%zu", folder, number);
    FILE *file = fopen(name, "wb");
    if (!file) return;
    fwrite(in->data, 1, in->size, file);
    fclose(file);
}

void fail(const char *what) {
    fprintf(stderr, "does not hold: %s\n", what);
    fflush(stderr);
    _Exit(3);
}

void expect(int holds, const char *what) {
    if (!holds) fail(what);
}

/* Whether the last run went a new way: places, and powers of two of how often they were passed. */
static int is_new(void) {
    int fresh = 0;
    for (size_t i = 0; i < PLACES; i += 8) {
        uint64_t some;
        memcpy(&some, counters + i, 8);
        for (size_t k = i; some && k < i + 8; k++) {
            uint8_t bit = counters[k] ? (uint8_t)(1 << (31 - __builtin_clz(counters[k]))) : 0;
            fresh |= bit & ~seen[k];
            seen[k] |= bit;
        }
    }
    return fresh != 0;
}

static int run(const input *in) {
    memset(counters, 0, sizeof counters);
    run_case(in->data, in->size);
    return is_new();
}

static void keep(const input *in) {
    if (inputs == MOST_INPUTS) return;
    corpus[inputs] = malloc(sizeof *in);
    memcpy(corpus[inputs++], in, sizeof *in);
}

static size_t shorter(size_t a, size_t b) { return a < b ? a : b; }

static void mutate(input *in) {
    const input *other = corpus[draw((uint32_t)inputs)];
    size_t at = draw((uint32_t)in->size + 1), from = draw((uint32_t)other->size + 1), n = 1 + draw(draw(2) ? 4 : 60);
    size_t rest = shorter(n, in->size - at);
    switch (draw(6)) {
        case 0:
            for (size_t i = 0; i < rest; i++) in->data[at + i] = (uint8_t)draw(256);
            break;
        case 1: /* taken out */
            memmove(in->data + at, in->data + at + rest, in->size - at - rest);
            in->size -= rest;
            break;
        case 2: /* put in */
            n = shorter(n, MOST_BYTES - in->size);
            memmove(in->data + at + n, in->data + at, in->size - at);
            for (size_t i = 0; i < n; i++) in->data[at + i] = (uint8_t)draw(256);
            in->size += n;
            break;
        case 3: /* copied from another one */
            memcpy(in->data + at, other->data + from, shorter(rest, other->size - from));
            break;
        case 4: /* the rest of another one */
            in->size = shorter(MOST_BYTES, at + other->size - from);
            memcpy(in->data + at, other->data + from, in->size - at);
            break;
        default:
            if (at < in->size) in->data[at] = (uint8_t)(in->data[at] + (draw(2) ? 1 : 255));
    }
}

static int read_input(const char *name, input *in) {
    FILE *file = fopen(name, "rb");
    if (!file) return 0;
    in->size = fread(in->data, 1, MOST_BYTES, file);
    fclose(file);
    return 1;
}

static void read_corpus(void) {
    char name[4096];
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
        if (strncmp(entry->d_name, "input-", 6) || !read_input(name, current)) continue;
        if (run(current)) keep(current);
    }
    if (entries) closedir(entries);
}

static void report(uint64_t runs, double seconds) {
    size_t places = 0, ways = 0;
    for (size_t i = 0; i < PLACES; i++) places += seen[i] != 0, ways += (size_t)__builtin_popcount(seen[i]);
    printf("%.0f s: %llu cases, %.0f a second, %zu kept, %zu places, %zu with counts\n", seconds, (unsigned long long)runs,
           (double)runs / seconds, inputs, places, ways);
    fflush(stdout);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int count, char **arguments) {
    if (count != 4 || !atof(arguments[1])) {
        static input only;
        for (int i = 1; i < count; i++) {
            if (!read_input(arguments[i], &only)) return 1;
            run_case(only.data, only.size);
        }
        return 0;
    }
    folder = arguments[3];
    share_current();
    double limit = atof(arguments[1]), start = now(), next = start + REPORT_SECONDS;
    state = strtoull(arguments[2], 0, 10);
    read_corpus();
    for (size_t i = 0; i < 64; i++) {
        current->size = 100 + draw(MOST_BYTES - 100);
        for (size_t k = 0; k < current->size; k++) current->data[k] = (uint8_t)draw(256);
        if (run(current)) keep(current);
    }
    uint64_t runs = 0;
    for (; now() - start < limit; runs++) {
        memcpy(current, corpus[draw(2) ? draw((uint32_t)inputs) : (uint32_t)inputs - 1 - draw((uint32_t)shorter(inputs, 50))], sizeof *current);
        for (uint32_t n = 1 + draw(1 + draw(8)); n; n--) mutate(current);
        if (run(current)) {
            keep(current);
            save(current, (size_t)time(0) * 100000 + inputs);
        }
        if (now() > next) next += REPORT_SECONDS, report(runs, now() - start);
    }
    report(runs, now() - start);
    return 0;
}
