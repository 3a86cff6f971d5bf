/* Weight maps in the kernel's form, and fixed parts taken out of them. */
#include "internal.h"

#include <string.h>

static int32_t words_of(const sm_views *views, int32_t view) { return (views->sizes[2 * view] + 63) >> 6; }

static void note_row(int32_t *rows, int32_t y) {
    if (rows[0] >= rows[1]) rows[0] = y;
    rows[1] = y + 1;
}

static void pack_row(const int16_t *map, int32_t width, uint64_t *plus, uint64_t *minus) {
    for (int32_t x = 0; x < width; x++) {
        plus[x >> 6] |= (uint64_t)(map[x] > 0) << (x & 63);
        minus[x >> 6] |= (uint64_t)(map[x] < 0) << (x & 63);
    }
}

/* Prefix sums of one row; returns whether it holds a weight. */
static int sum_row(const int16_t *map, int32_t width, int32_t *sums) {
    int32_t sum = 0, any = 0;
    for (int32_t x = 0; x < width; x++) {
        sums[x] = sum;
        sum += map[x];
        any |= map[x];
    }
    sums[width] = sum;
    return any != 0;
}

static void prepare_view(const sm_views *views, int32_t view, const int16_t *maps, sm_weights *out) {
    int32_t width = views->sizes[2 * view], height = views->sizes[2 * view + 1], words = words_of(views, view);
    int32_t *rows = out->rows + 2 * view;
    rows[0] = rows[1] = 0;
    for (int32_t y = 0; y < height; y++) {
        const int16_t *map = maps + views->map_starts[view] + (int64_t)y * width;
        int any = 0;
        if (out->kind == SM_PLANES) {
            int64_t at = views->word_starts[view] + (int64_t)y * words;
            memset(out->plus + at, 0, 8 * (size_t)words);
            memset(out->minus + at, 0, 8 * (size_t)words);
            pack_row(map, width, out->plus + at, out->minus + at);
            for (int32_t k = 0; k < words; k++) any |= (out->plus[at + k] | out->minus[at + k]) != 0;
        } else {
            memcpy(out->maps + views->map_starts[view] + (int64_t)y * width, map, 2 * (size_t)width);
            any = sum_row(map, width, out->sums + views->sum_starts[view] + (int64_t)y * (width + 1));
        }
        if (any) note_row(rows, y);
    }
}

int32_t sm_prepare(const sm_views *views, const int16_t *maps, sm_weights *out) {
    if (out->kind != SM_PLANES && out->kind != SM_MAPS) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++) prepare_view(views, v, maps, out);
    return SM_OK;
}

/* The bits of word k that lie in the columns from x0 to x1. */
static uint64_t window_bits(int32_t k, int32_t x0, int32_t x1) {
    int32_t first = x0 - 64 * k, last = x1 - 64 * k;
    if (last <= 0 || first >= 64) return 0;
    return (first > 0 ? ~0ull << first : ~0ull) & (last < 64 ? ~0ull >> (64 - last) : ~0ull);
}

static void mask_planes(const sm_weights *in, int64_t at, uint64_t fixed, uint64_t window, sm_weights *out,
                        int64_t *constant) {
    uint64_t plus = in->plus[at], minus = in->minus[at];
    *constant += __builtin_popcountll(plus & fixed) - __builtin_popcountll(minus & fixed);
    out->plus[at] = plus & ~fixed & window;
    out->minus[at] = minus & ~fixed & window;
}

static void mask_map(const int16_t *in, int32_t n, uint64_t fixed, uint64_t window, int16_t *out,
                     int64_t *constant) {
    uint64_t keep = ~fixed & window;
    for (int32_t i = 0; i < n; i++) {
        if (fixed >> i & 1) *constant += in[i];
        out[i] = (int16_t)(keep >> i & 1 ? in[i] : 0);
    }
}

static void mask_view(const sm_views *views, int32_t view, const sm_weights *in, const uint64_t *fixed,
                      const int32_t *window, sm_weights *out) {
    int32_t width = views->sizes[2 * view], height = views->sizes[2 * view + 1], words = words_of(views, view);
    int32_t *rows = out->rows + 2 * view;
    int64_t constant = in->constants[view];
    rows[0] = rows[1] = 0;
    for (int32_t y = 0; y < height; y++) {
        int any = 0, inside = !window || (y >= window[1] && y < window[3]);
        for (int32_t k = 0; k < words; k++) {
            uint64_t bits = !inside ? 0 : window ? window_bits(k, window[0], window[2]) : ~0ull;
            int64_t at = views->word_starts[view] + (int64_t)y * words + k;
            if (out->kind == SM_PLANES) {
                mask_planes(in, at, fixed[at], bits, out, &constant);
                any |= (out->plus[at] | out->minus[at]) != 0;
                continue;
            }
            int64_t pixel = views->map_starts[view] + (int64_t)y * width + 64 * k;
            mask_map(in->maps + pixel, width - 64 * k < 64 ? width - 64 * k : 64, fixed[at], bits,
                     out->maps + pixel, &constant);
        }
        if (out->kind == SM_MAPS)
            any = sum_row(out->maps + views->map_starts[view] + (int64_t)y * width, width,
                          out->sums + views->sum_starts[view] + (int64_t)y * (width + 1));
        if (any) note_row(rows, y);
    }
    out->constants[view] = constant;
}

int32_t sm_mask(const sm_views *views, const sm_weights *in, const uint64_t *fixed, const int32_t *windows,
                sm_weights *out) {
    if (in->kind != out->kind || (in->kind != SM_PLANES && in->kind != SM_MAPS)) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++)
        mask_view(views, v, in, fixed, windows ? windows + 4 * v : 0, out);
    return SM_OK;
}
