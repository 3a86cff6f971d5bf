/* Weight maps in the kernel's form, and fixed parts taken out of them. All go column by column. */
#include "internal.h"

#include <string.h>

typedef struct {
    int64_t width, height, words; /* px, px, words to a row */
    size_t bits, pixels, sums;    /* where the view starts in the arrays */
} place;

static place place_of(const sm_views *views, int32_t view) {
    int64_t width = views->sizes[2 * view], height = views->sizes[2 * view + 1];
    return (place){width, height, (width + 63) >> 6, (size_t)views->word_starts[view],
                   (size_t)views->map_starts[view], (size_t)views->sum_starts[view]};
}

/* Widens the rows from first to last + 1 by those of a column that are not 0. */
static void note(const uint64_t *used, int64_t height, int32_t *rows) {
    int64_t first = 0, last = height;
    while (first < height && !used[first]) first++;
    if (first == height) return;
    while (!used[last - 1]) last--;
    int none = rows[0] >= rows[1];
    if (none || first < rows[0]) rows[0] = (int32_t)first;
    if (none || last > rows[1]) rows[1] = (int32_t)last;
}

/* Sums left of every column, from the weights of a word's columns; notes which rows hold some. */
static void add_up(const place *p, int64_t word, sm_weights *weights, uint64_t *used) {
    memset(used, 0, 8 * (size_t)p->height);
    int64_t end = 64 * word + 64 < p->width ? 64 * word + 64 : p->width;
    for (int64_t x = 64 * word; x < end; x++) {
        const int16_t *restrict map = weights->maps + p->pixels + (size_t)(x * p->height);
        const int32_t *restrict left = weights->sums + p->sums + (size_t)(x * p->height);
        int32_t *restrict right = weights->sums + p->sums + (size_t)((x + 1) * p->height);
        for (int64_t y = 0; y < p->height; y++) {
            right[y] = left[y] + map[y];
            used[y] |= map[y] != 0;
        }
    }
}

/* A word of 64 bytes, each 0 or 1: the product's highest byte holds eight of them side by side. */
static uint64_t word_of(const uint8_t *bytes) {
    uint64_t word = 0;
    for (int i = 0; i < 64; i += 8) {
        uint64_t eight = 0;
        for (int k = 0; k < 8; k++) eight |= (uint64_t)bytes[i + k] << 8 * k;
        word |= (eight * 0x0102040810204080ull >> 56) << i;
    }
    return word;
}

/* Signs of a word's columns as two bit planes. */
static void pack(const place *p, const int16_t *maps, int64_t word, uint64_t *plus, uint64_t *minus) {
    int64_t columns = p->width - 64 * word < 64 ? p->width - 64 * word : 64;
    uint8_t above[64] = {0}, below[64] = {0};
    for (int64_t y = 0; y < p->height; y++) {
        const int16_t *map = maps + p->pixels + (size_t)(y * p->width + 64 * word);
        for (int64_t x = 0; x < columns; x++) {
            above[x] = map[x] > 0;
            below[x] = map[x] < 0;
        }
        plus[y] = word_of(above);
        minus[y] = word_of(below);
    }
}

static void prepare_view(const sm_views *views, int32_t view, const int16_t *maps, sm_weights *out, uint64_t *used) {
    place p = place_of(views, view);
    int32_t *rows = out->rows + 2 * view;
    rows[0] = rows[1] = 0;
    if (out->kind == SM_MAPS) {
        memset(out->sums + p.sums, 0, 4 * (size_t)p.height);
        for (int64_t y = 0; y < p.height; y++)
            for (int64_t x = 0; x < p.width; x++)
                out->maps[p.pixels + (size_t)(x * p.height + y)] = maps[p.pixels + (size_t)(y * p.width + x)];
    }
    for (int64_t k = 0; k < p.words; k++) {
        if (out->kind == SM_PLANES) {
            uint64_t *plus = out->plus + p.bits + k * p.height, *minus = out->minus + p.bits + k * p.height;
            pack(&p, maps, k, plus, minus);
            for (int64_t y = 0; y < p.height; y++) used[y] = plus[y] | minus[y];
        } else
            add_up(&p, k, out, used);
        note(used, p.height, rows);
    }
}

int32_t sm_prepare(const sm_views *views, const int16_t *maps, sm_weights *out, uint64_t *column) {
    if (out->kind != SM_PLANES && out->kind != SM_MAPS) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++) prepare_view(views, v, maps, out, column);
    return SM_OK;
}

/* The bits of word k that lie in columns x0 to x1 (exclusive). */
static uint64_t window_bits(int64_t k, int32_t x0, int32_t x1) {
    int64_t first = x0 - 64 * k, last = x1 - 64 * k;
    if (last <= 0 || first >= 64 || first >= last) return 0;
    return (first > 0 ? ~0ull << first : ~0ull) & (last < 64 ? ~0ull >> (64 - last) : ~0ull);
}

static int64_t mask_planes(const uint64_t *fixed, const uint64_t *keep, int64_t height, const uint64_t *in_plus,
                           const uint64_t *in_minus, uint64_t *plus, uint64_t *minus) {
    int64_t constant = 0;
    for (int64_t y = 0; y < height; y++) {
        constant += __builtin_popcountll(in_plus[y] & fixed[y]) - __builtin_popcountll(in_minus[y] & fixed[y]);
        plus[y] = in_plus[y] & ~fixed[y] & keep[y];
        minus[y] = in_minus[y] & ~fixed[y] & keep[y];
    }
    return constant;
}

static int64_t mask_maps(const uint64_t *fixed, const uint64_t *keep, const place *p, int64_t word,
                         const int16_t *in, int16_t *out) {
    int64_t constant = 0, end = 64 * word + 64 < p->width ? 64 * word + 64 : p->width;
    for (int64_t x = 64 * word; x < end; x++) {
        const int16_t *restrict from = in + p->pixels + (size_t)(x * p->height);
        int16_t *restrict to = out + p->pixels + (size_t)(x * p->height);
        int64_t sum = 0;
        for (int64_t y = 0; y < p->height; y++) {
            sum += fixed[y] >> (x & 63) & 1 ? from[y] : 0;
            to[y] = (~fixed[y] & keep[y]) >> (x & 63) & 1 ? from[y] : 0;
        }
        constant += sum;
    }
    return constant;
}

static void mask_view(const sm_views *views, int32_t view, const sm_weights *in, const uint64_t *fixed,
                      const int32_t *window, sm_weights *out, uint64_t *column) {
    place p = place_of(views, view);
    int32_t *rows = out->rows + 2 * view;
    rows[0] = rows[1] = 0;
    out->constants[view] = in->constants[view];
    if (out->kind == SM_MAPS) memset(out->sums + p.sums, 0, 4 * (size_t)p.height);
    for (int64_t k = 0; k < p.words; k++) {
        size_t at = p.bits + (size_t)(k * p.height);
        uint64_t bits = window ? window_bits(k, window[0], window[2]) : ~0ull;
        for (int64_t y = 0; y < p.height; y++) column[y] = !window || (y >= window[1] && y < window[3]) ? bits : 0;
        if (out->kind == SM_PLANES) {
            out->constants[view] += mask_planes(fixed + at, column, p.height, in->plus + at, in->minus + at,
                                                out->plus + at, out->minus + at);
            for (int64_t y = 0; y < p.height; y++) column[y] = out->plus[at + y] | out->minus[at + y];
        } else {
            out->constants[view] += mask_maps(fixed + at, column, &p, k, in->maps, out->maps);
            add_up(&p, k, out, column);
        }
        note(column, p.height, rows);
    }
}

int32_t sm_mask(const sm_views *views, const sm_weights *in, const uint64_t *fixed, const int32_t *windows,
                sm_weights *out, uint64_t *column) {
    if (in->kind != out->kind || (in->kind != SM_PLANES && in->kind != SM_MAPS)) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++)
        mask_view(views, v, in, fixed, windows ? windows + 4 * v : 0, out, column);
    return SM_OK;
}
