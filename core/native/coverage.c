/* One view of one pose: which segments are drawn how, and what the picture weighs. */
#include "path.h"

enum { HIDDEN, PLAIN, CLIPPED };

/* a = projection * transform: joint's metres to homogeneous px. */
static void compose(const double *p, const double *m, double *a) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            a[4 * i + j] = p[4 * i] * m[j] + p[4 * i + 1] * m[4 + j] + p[4 * i + 2] * m[8 + j];
        a[4 * i + 3] += p[4 * i + 3];
    }
}

/* Where the sphere round a segment lies. Only ever a short cut: no result depends on it. */
static int place(const sm_views *views, int32_t view, const double *m, const double *sphere) {
    double centre[3], radius = sphere[3] * (1.0 + 1e-9) + 1e-9;
    for (int i = 0; i < 3; i++)
        centre[i] = m[4 * i] * sphere[0] + m[4 * i + 1] * sphere[1] + m[4 * i + 2] * sphere[2] + m[4 * i + 3];
    int inside = 1;
    for (int k = 0; k < 9; k++) {
        const double *plane = views->planes + (9 * (size_t)view + k) * 4;
        double distance = plane[0] * centre[0] + plane[1] * centre[1] + plane[2] * centre[2] + plane[3];
        if (distance < -radius) return HIDDEN;
        if (k < 5 && !(distance > radius)) inside = 0;
    }
    return inside ? PLAIN : CLIPPED;
}

static void draw(const sm_body *body, const sm_views *views, const int32_t *segments, int32_t count,
                 sm_work *work) {
    for (int32_t k = 0; k < count; k++) {
        int32_t s = segments[k];
        for (int32_t view = 0; view < views->views; view++) {
            sm_picture *picture = work->pictures + view;
            const double *m = sm_transform(body, work, view, s);
            if (picture->top >= picture->bottom) continue;
            int where = place(views, view, m, body->spheres + 4 * (size_t)s);
            if (where == HIDDEN) continue;
            double a[12];
            compose(views->projections + 12 * (size_t)view, m, a);
            if (where == PLAIN && sm_draw_contours(body, views, view, s, a, work)) continue;
            sm_draw_triangles(body, views->near, s, a, picture);
        }
    }
}

static int64_t sum_planes(const uint64_t *rows, const uint64_t *plus, const uint64_t *minus, size_t n) {
    int64_t sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += __builtin_popcountll(rows[k] & plus[k]) - __builtin_popcountll(rows[k] & minus[k]);
    return sum;
}

static int64_t sum_spans(const uint64_t *row, const int32_t *sums, int32_t words, int32_t width) {
    int64_t sum = 0;
    uint64_t carry = 0;
    for (int32_t k = 0; k < words; k++) {
        uint64_t bits = row[k], changes = bits ^ (bits << 1 | carry);
        carry = bits >> 63;
        for (; changes; changes &= changes - 1) {
            int i = __builtin_ctzll(changes);
            sum += bits >> i & 1 ? -(int64_t)sums[64 * k + i] : sums[64 * k + i];
        }
    }
    return carry ? sum + sums[width] : sum;
}

static int64_t sum(const sm_views *views, const sm_weights *weights, int32_t view, const sm_picture *picture) {
    int32_t width = picture->width, words = picture->words;
    size_t start = (size_t)words * picture->y0, n = (size_t)words * (picture->y1 - picture->y0);
    if (weights->kind == SM_PLANES) {
        size_t at = (size_t)views->word_starts[view] + start;
        return sum_planes(picture->rows + start, weights->plus + at, weights->minus + at, n);
    }
    int64_t total = 0;
    const int32_t *sums = weights->sums + views->sum_starts[view];
    for (int32_t y = picture->y0; y < picture->y1; y++)
        total += sum_spans(picture->rows + (size_t)words * y, sums + (size_t)(width + 1) * y, words, width);
    return total;
}

static int32_t snap_checked(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                            sm_work *work) {
    double a[12], h[3];
    int32_t start = body->vertex_starts[segment], n = body->vertex_starts[segment + 1] - start, clean = 1;
    compose(views->projections + 12 * (size_t)view, sm_transform(body, work, view, segment), a);
    for (int32_t i = 0; i < n; i++) {
        homogeneous(body, a, start + i, h);
        int32_t kept = is_inside(h, views->near);
        double w = 1.0 / h[2];
        work->qx[i] = kept ? snap(h[0] * w) : INT32_MIN;
        work->qy[i] = kept ? snap(h[1] * w) : INT32_MIN;
        clean &= kept;
    }
    return clean;
}

const sm_path PATH(sm_path_) = {draw, sum, snap_checked};
