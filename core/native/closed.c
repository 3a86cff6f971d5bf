/* Closed surfaces: an edge is drawn only between a face that shows its front and one that shows its
 * back, and crosses a row with winding +1 or -1. So bits are stepped right of every crossing in any
 * order, in planes that count modulo 4 or 8; winding is never negative, and at most half as high as
 * a row has crossings. A face without snapped area may pass for either, as its crossings cancel.
 *
 * The pixels right of a crossing c start at x = ceil(c) = floor(c + 1 - 1 / (512 dy)), as c is a
 * multiple of 1 / (256 dy) px. In steps of 2^-46 px the sum over up to 8,192 rows is off by less than
 * 2^-33 px, so its integer part is exact for dy up to 2^23 (twice the guard region).
 */
#include "path.h"

#include <math.h>

/* Loops over a multiple of eight: no remainder is worth a loop of its own. */
#define WHOLE_BLOCKS _Pragma("clang loop vectorize_width(8) interleave_count(1)")

enum { FRACTION = 46, MOST_ROWS = 8192, FEW_CLUSTERS = 16, BLOCK = 8 };

static inline int32_t up_to(int32_t n, int32_t multiple) { return (n + multiple - 1) / multiple * multiple; }

/* Which clusters have edges that may be drawn; the margins of all. */
static int32_t look_over(const sm_body *body, int32_t segment, const eye *e, sm_work *work) {
    int32_t start = body->edge_starts[segment], n = body->edge_starts[segment + 1] - start;
    size_t stride = (size_t)body->edge_clusters;
    const float *restrict m1 = body->edge_cones + 6 * stride + start, *restrict m2 = m1 + stride;
    float *restrict margins = work->edges.margins;
    for (int32_t k = 0; k < up_to(n, 16); k++) margins[k] = e->edge * m1[k] + e->step * m2[k] + e->slack;
    if (n > FEW_CLUSTERS) return sm_glance(body->edge_cones, stride, start, n, e, work->runs);
    for (int32_t k = 0; k < n; k++) work->runs[k] = start + k;
    return n;
}

static inline int64_t packed(double px, double py) {
    double x = px * 256.0 + 6755399441055744.0, y = py * 256.0 + 6755399441055744.0;
    int64_t low, high;
    memcpy(&low, &x, sizeof low);
    memcpy(&high, &y, sizeof high);
    return (int64_t)((uint64_t)high << 32 | ((uint64_t)low & 0xffffffff));
}

static inline int32_t x_of(int64_t point) { return (int32_t)point; }
static inline int32_t y_of(int64_t point) { return (int32_t)(point >> 32); }

/* What n crossings reach: rows and columns, and how many rows each edge crosses in all. */
typedef struct {
    int32_t n, top, bottom, left, right, crossings;
} extent;

/* The three steps that are worth their own code where there are lanes of 512 bits. */
#if defined(__AVX512F__)
#include "closed_lanes.h"
#else
#include "closed_plain.h"
#endif

/* Snaps all vertices of a segment that lies in the guard region. */
static void project(const sm_body *body, int32_t segment, const double *a, sm_work *work) {
    int32_t start = body->vertex_starts[segment], n = body->vertex_starts[segment + 1] - start;
    const float *restrict px = body->x + start, *restrict py = body->y + start, *restrict pz = body->z + start;
    int64_t *restrict points = work->points;
    double a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], b0 = a[4], b1 = a[5], b2 = a[6], b3 = a[7];
    double c0 = a[8], c1 = a[9], c2 = a[10], c3 = a[11];
    WHOLE_BLOCKS for (int32_t i = 0; i < up_to(n, BLOCK); i++) {
        double x = px[i], y = py[i], z = pz[i], w = 1.0 / (c0 * x + c1 * y + c2 * z + c3);
        points[i] = packed((a0 * x + a1 * y + a2 * z + a3) * w, (b0 * x + b1 * y + b2 * z + b3) * w);
    }
}

/* Keeps those of the open edges whose faces look different ways by their snapped areas. */
static int32_t settle(const sm_body *body, int32_t front, int32_t n, int32_t clusters, sm_work *work, int *flat) {
    const int64_t *restrict points = work->points;
    uint32_t *restrict sure = work->edges.sure;
    int flats = 0;
    for (int32_t k = 0; k < clusters; k += 4) {
        for (uint64_t open = work->edges.open[k >> 2]; open; open &= open - 1) {
            int bit = __builtin_ctzll(open);
            size_t edge = 16 * (size_t)work->runs[k + bit / 16] + bit % 16;
            const int32_t *c = body->edge_corners + 4 * edge;
            int64_t p = points[c[0]], q = points[c[1]], r = points[c[2]], s = points[c[3]];
            int64_t dx = x_of(q) - x_of(p), dy = y_of(q) - y_of(p);
            int64_t one = dx * (y_of(r) - y_of(p)) - dy * (x_of(r) - x_of(p));
            int64_t other = dy * (x_of(s) - x_of(p)) - dx * (y_of(s) - y_of(p));
            int first = front * one > 0, second = front * other > 0;
            flats |= one == 0 || other == 0;
            sure[n] = body->edge_ends[edge] | (uint32_t)!first << 31;
            n += first ^ second;
        }
    }
    *flat = flats;
    return n;
}

/* The most crossings of a row; counts fall back to 0. */
static uint64_t most_crossings(const extent *all, sm_edges *e) {
    uint64_t most = 0, *restrict counts = e->counts + (all->top & -BLOCK);
    int32_t n = up_to(all->bottom, BLOCK) - (all->top & -BLOCK);
    WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) {
        most = counts[i] > most ? counts[i] : most;
        counts[i] = 0;
    }
    return most;
}

/* Moves a word of the window, whose first bit is column `left`, into the picture; rows come in blocks,
 * as those without crossings change nothing. */
static inline void add_word(const extent *all, int32_t word, int32_t left, int planes, sm_picture *picture, sm_edges *e) {
    uint64_t *restrict p0 = e->planes[0] + e->rows * (size_t)word, *restrict p1 = e->planes[1] + e->rows * (size_t)word;
    uint64_t *restrict p2 = e->planes[2] + e->rows * (size_t)word;
    int shift = left & 63, rest = picture->width - left;
    uint64_t keep = rest < 64 ? ~0ull >> (64 - rest) : ~0ull;
    uint64_t *restrict one = picture->bits + (size_t)picture->height * (size_t)(left >> 6), *restrict two = one + picture->height;
    int spills = shift && (all->right - 1) >> 6 > left >> 6;
    int32_t first = all->top & -BLOCK, n = up_to(all->bottom, BLOCK) - first;
    p0 += first, p1 += first, p2 += first, one += first, two += first;
    WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) {
        uint64_t bits = (p0[i] | p1[i] | (planes == 3 ? p2[i] : 0)) & keep;
        one[i] |= bits << shift;
        p0[i] = bits;
        p1[i] = 0;
        if (planes == 3) p2[i] = 0;
    }
    if (spills)
        WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) two[i] |= p0[i] >> (64 - shift);
    WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) p0[i] = 0;
}

static void clear(const extent *all, int32_t words, sm_edges *e) {
    for (int p = 0; p < 3; p++)
        for (int32_t w = 0; w < words; w++)
            memset(e->planes[p] + e->rows * (size_t)w + all->top, 0, 8 * (size_t)(all->bottom - all->top));
}

/* Fills the window of `words` columns of words, whose first bit is column all->left; returns the
 * number of planes, or 0 where a row has too many crossings. */
static int fill(const extent *all, int32_t words, int counted, sm_edges *e) {
    int32_t left = all->left;
    if (counted) step(all->n, 0, left, 2, 1, e);
    for (int32_t w = counted; w < words; w++) step(all->n, w, left + 64 * w, 2, 0, e);
    uint64_t most = counted ? most_crossings(all, e) : 0;
    if (most <= 6) return 2;
    clear(all, words, e);
    for (int32_t w = 0; w < words && most <= 14; w++) step(all->n, w, left + 64 * w, 3, 0, e);
    return most <= 14 ? 3 : 0;
}

int32_t sm_draw_closed(const sm_body *body, int32_t segment, const eye *e, const double *a, sm_picture *picture,
                       sm_work *work) {
    sm_edges *edges = &work->edges;
    int32_t start = body->edge_starts[segment], flat;
    if (start == body->edge_starts[segment + 1] || picture->height > MOST_ROWS) return 0;
    int32_t clusters = look_over(body, segment, e, work), sure = find(body, start, clusters, e, work);
    project(body, segment, a, work);
    sure = settle(body, e->front, sure, clusters, work, &flat);
    extent all = take(e->front, sure, picture, work);
    if (all.n < 0) return 0;
    all.left = all.left < 0 ? 0 : all.left;
    all.right = all.right > picture->width ? picture->width : all.right;
    if (!all.n || all.left >= all.right) return 1;

    /* a connected surface crosses every row at least twice, unless faces without area do */
    int counted = all.crossings - 2 * (all.bottom - all.top) > 4 || flat || !body->connected[segment];
    int32_t words = (all.right - all.left + 63) / 64, bottom = up_to(all.bottom, BLOCK);
    int planes = fill(&all, words, counted, edges);
    if (!planes) return 0;
    open_words(picture, all.left >> 6, ((all.right - 1) >> 6) + 1, all.top & -BLOCK,
               bottom < picture->height ? bottom : picture->height);
    for (int32_t w = 0; w < words; w++) {
        if (planes == 3) add_word(&all, w, all.left + 64 * w, 3, picture, edges);
        else add_word(&all, w, all.left + 64 * w, 2, picture, edges);
    }
    return 1;
}
