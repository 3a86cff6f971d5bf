/* What the kernel says must fit together. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_WORK = 3000000 };

void compare_answers(const scene *s, const question *q, const answer *a, const answer *b) {
    size_t views = (size_t)s->views.views, n = (size_t)q->poses;
    expect(!memcmp(a->snapped, b->snapped, 8 * views * (size_t)s->body.vertices), "paths snap alike");
    expect(!memcmp(a->bounds, b->bounds, 16 * n * views), "paths bound alike");
    expect(!memcmp(a->bits, b->bits, 8 * (size_t)q->words), "paths draw alike");
    size_t found = (size_t)a->outline.starts[views], kept = found < (size_t)q->room ? found : (size_t)q->room;
    expect(!memcmp(a->outline.starts, b->outline.starts, 8 * (views + 1)), "paths find as many points");
    expect(!memcmp(a->outline.segments, b->outline.segments, 4 * kept) && !memcmp(a->outline.points, b->outline.points, 24 * kept) &&
               !memcmp(a->outline.px, b->outline.px, 16 * kept) && !memcmp(a->outline.normals, b->outline.normals, 16 * kept),
           "paths outline alike");
    for (int k = 0; k < 2; k++) expect(!memcmp(a->energies[k], b->energies[k], 8 * n * views), "paths sum alike");
}

/* The weights under `bits` that are not under `fixed`, in the window (or null). */
static int64_t weighed(const scene *s, const question *q, int32_t v, const uint64_t *bits, const uint64_t *fixed, const int32_t *window) {
    int64_t width = s->views.sizes[2 * v], height = s->views.sizes[2 * v + 1], at = s->views.word_starts[v], sum = 0;
    for (int64_t k = 0; 64 * k < width; k++)
        for (int64_t y = 0; y < height; y++, at++)
            for (uint64_t rest = bits[at] & ~(fixed ? fixed[at] : 0); rest; rest &= rest - 1) {
                int64_t x = 64 * k + __builtin_ctzll(rest);
                expect(x < width, "no bit lies beyond the picture");
                if (window && (x < window[0] || y < window[1] || x >= window[2] || y >= window[3])) continue;
                sum += q->maps[s->views.map_starts[v] + y * width + x];
            }
    return sum;
}

static void check_energies(scene *s, const question *q, const sm_weights *weights, const answer *a) {
    int32_t views = s->views.views;
    int64_t *alone = new_room(s, (size_t)views, 8);
    for (int32_t v = 0; v < views; v++)
        expect(a->energies[0][v] == q->constants[v] + weighed(s, q, v, a->bits, 0, 0), "an energy is the weight of its silhouette");
    for (int32_t n = 0; n < q->poses; n++) {
        CALL(sm_energies, weights, q->pose + n * s->body.dofs, 1, 0, q->segments, q->count, alone);
        expect(!memcmp(alone, a->energies[0] + n * views, 8 * (size_t)views), "a batch is its poses one by one");
        for (int32_t v = 0; v < views; v++)
            expect(a->energies[1][n * views + v] == a->energies[0][(n + v) % q->poses * views + v], "every view sees its own pose");
    }
    sm_weights other = prepared(s, q, SM_MAPS);
    CALL(sm_energies, &other, q->pose, 1, 0, q->segments, q->count, alone);
    expect(!memcmp(alone, a->energies[0], 8 * (size_t)views), "maps weigh like planes");
}

/* Points of an outline lie in the bounds; the pixel beside each is in the picture and not covered. */
static void check_outline(const scene *s, const question *q, const answer *a) {
    for (int32_t v = 0; v < s->views.views; v++)
        for (int64_t i = a->outline.starts[v]; i < a->outline.starts[v + 1] && i < q->room; i++) {
            const double *px = a->outline.px + 2 * i, *n = a->outline.normals + 2 * i;
            const int32_t *box = a->bounds + 4 * v;
            double x = floor(px[0] + 0.75 * n[0] + 0.5), y = floor(px[1] + 0.75 * n[1] + 0.5);
            expect(fabs(n[0] * n[0] + n[1] * n[1] - 1.0) < 1e-9, "normals are of length 1");
            expect(x >= 0 && y >= 0 && x < s->views.sizes[2 * v] && y < s->views.sizes[2 * v + 1], "an outline lies in the picture");
            int64_t word = s->views.word_starts[v] + ((int64_t)x >> 6) * s->views.sizes[2 * v + 1] + (int64_t)y;
            expect(!(a->bits[word] >> ((int64_t)x & 63) & 1), "beside an outline nothing is covered");
            expect(px[0] >= box[0] - 1 && px[1] >= box[1] - 1 && px[0] <= box[2] && px[1] <= box[3], "an outline lies in the bounds");
        }
}

/* Bounds are those of the snapped vertices. */
static void check_bounds(const scene *s, const question *q, const answer *a) {
    for (int32_t v = 0; v < s->views.views; v++) {
        int64_t box[4] = {INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN}, any = 0, lost = 0;
        for (int32_t k = 0; k < q->count; k++)
            for (int32_t i = s->body.vertex_starts[q->segments[k]]; i < s->body.vertex_starts[q->segments[k] + 1]; i++, any = 1) {
                const int32_t *at = a->snapped + 2 * ((int64_t)s->body.vertices * v + i);
                lost |= at[0] == INT32_MIN;
                for (int j = 0; j < 2; j++) {
                    box[j] = at[j] < box[j] ? at[j] : box[j];
                    box[2 + j] = at[j] > box[2 + j] ? at[j] : box[2 + j];
                }
            }
        for (int j = 0; j < 4; j++) {
            int64_t wanted = lost ? (j < 2 ? -16000 : 16000) : (box[j] + 255) >> 8;
            expect(a->bounds[4 * v + j] == (any ? wanted : 0), "bounds are those of the vertices");
        }
    }
}

static int64_t side(const int32_t *a, const int32_t *b, int64_t x, int64_t y) {
    return ((int64_t)b[0] - a[0]) * (y - a[1]) - ((int64_t)b[1] - a[1]) * (x - a[0]);
}

static int is_in(const int32_t *a, const int32_t *b, int64_t x, int64_t y) {
    int64_t s = side(a, b, x, y);
    return s > 0 || (s == 0 && (b[1] < a[1] || (b[1] == a[1] && b[0] > a[0])));
}

/* Draws a snapped triangle by its three edges; returns the pixels looked at. */
static int64_t draw(const scene *s, int32_t v, const int32_t *a, const int32_t *b, const int32_t *c, uint64_t *bits) {
    int64_t area = side(a, b, c[0], c[1]), low[2], high[2];
    if (area == 0) return 0;
    if (area < 0) {
        const int32_t *swap = b;
        b = c, c = swap;
    }
    for (int i = 0; i < 2; i++) {
        int64_t least = a[i] < b[i] ? a[i] : b[i], most = a[i] < b[i] ? b[i] : a[i], end = s->views.sizes[2 * v + i];
        least = (c[i] < least ? c[i] : least) / 256 - 1, most = (c[i] > most ? c[i] : most) / 256 + 2;
        low[i] = least < 0 ? 0 : least, high[i] = most > end ? end : most;
    }
    for (int64_t y = low[1]; y < high[1]; y++)
        for (int64_t x = low[0]; x < high[0]; x++)
            if (is_in(a, b, 256 * x, 256 * y) && is_in(b, c, 256 * x, 256 * y) && is_in(c, a, 256 * x, 256 * y))
                bits[s->views.word_starts[v] + (x >> 6) * s->views.sizes[2 * v + 1] + y] |= 1ull << (x & 63);
    return low[0] < high[0] && low[1] < high[1] ? (high[0] - low[0]) * (high[1] - low[1]) : 0;
}

/* Silhouettes are what the snapped triangles cover, where none is clipped. */
static void check_silhouettes(scene *s, const question *q, const answer *a) {
    uint64_t *bits = new_array(s, (size_t)q->words, 8);
    int64_t work = 0;
    for (int32_t v = 0; v < s->views.views && work < MOST_WORK; v++) {
        const int32_t *snapped = a->snapped + 2 * (int64_t)s->body.vertices * v;
        int lost = 0;
        for (int32_t k = 0; k < q->count && !lost && work < MOST_WORK; k++) {
            int32_t first = s->body.vertex_starts[q->segments[k]], *clusters = (int32_t *)s->body.cluster_starts + q->segments[k];
            for (int32_t i = first; i < s->body.vertex_starts[q->segments[k] + 1]; i++) lost |= snapped[2 * i] == INT32_MIN;
            for (int32_t f = SM_CLUSTER * clusters[0]; f < SM_CLUSTER * clusters[1] && !lost && work < MOST_WORK; f++) {
                const int32_t *c = s->body.corners + 3 * f;
                work += draw(s, v, snapped + 2 * (first + c[0]), snapped + 2 * (first + c[1]), snapped + 2 * (first + c[2]), bits);
            }
        }
        int64_t at = s->views.word_starts[v], words = s->views.word_starts[v + 1] - at;
        if (!lost && work < MOST_WORK) expect(!memcmp(bits + at, a->bits + at, 8 * (size_t)words), "a silhouette is what its triangles cover");
    }
}

/* The listed segments move, all others are taken out of the weights. */
static void check_masks(reader *r, scene *s, const question *q, const sm_weights *weights, const answer *a) {
    int32_t views = s->views.views, fixed[MOST_SEGMENTS], n = 0, *windows = new_array(s, 4 * (size_t)views, 4);
    uint64_t *covered = new_words(s, q), *column = malloc(8 * (size_t)q->height);
    int64_t *energies = new_room(s, (size_t)views, 8);
    sm_weights masked = new_weights(s, q, weights->kind);
    for (int32_t k = 0; k < s->body.segments; k++) {
        int moves = 0;
        for (int32_t i = 0; i < q->count; i++) moves |= q->segments[i] == k;
        if (!moves) fixed[n++] = k;
    }
    int narrow = read_below(r, 2) == 1;
    for (int32_t i = 0; i < 4 * views; i++) windows[i] = (int32_t)read_number(r, i & 2 ? 250 : 60);
    CALL(sm_silhouettes, q->pose, 0, fixed, n, covered);
    expect(sm_mask(&s->views, weights, covered, narrow ? windows : 0, &masked, column) == SM_OK, "weights are masked");
    CALL(sm_energies, &masked, q->pose, 1, 0, q->segments, q->count, energies);
    for (int32_t v = 0; v < views; v++) {
        int64_t moving = weighed(s, q, v, a->bits, covered, narrow ? windows + 4 * v : 0);
        expect(energies[v] == q->constants[v] + weighed(s, q, v, covered, 0, 0) + moving, "masked weights give the full energy");
    }
    free(column);
}

static void check_refusals(scene *s, question *q, const sm_weights *weights, int64_t *out) {
    int32_t beyond = s->body.segments, processor = s->views.processor;
    q->bytes--;
    expect(sm_energies(&s->body, &s->views, weights, q->pose, 1, 0, q->segments, 0, out, q->scratch, q->bytes++) == SM_SCRATCH, "scratch is counted");
    expect(sm_energies(&s->body, &s->views, weights, q->pose, 1, 0, &beyond, 1, out, q->scratch, q->bytes) == SM_INDEX, "segments are looked at");
    s->views.processor = 2;
    expect(sm_check(&s->body, &s->views) == SM_PROCESSOR, "code paths are known");
    s->views.processor = processor;
}

void check_answers(reader *r, scene *s, question *q, const sm_weights *weights, const answer *a) {
    check_energies(s, q, weights, a);
    check_bounds(s, q, a);
    check_outline(s, q, a);
    check_silhouettes(s, q, a);
    check_masks(r, s, q, weights, a);
    check_refusals(s, q, weights, a->energies[1]);
}
