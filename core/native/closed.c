/* Closed surfaces: an edge is drawn only between a face that shows its front and one that shows its
 * back, and crosses a row with winding +1 or -1. So bits are stepped right of every crossing in any
 * order, in planes that count modulo 4 or 8; winding is never negative, and at most half as high as
 * a row has crossings. A face without snapped area may pass for either, as its crossings cancel.
 *
 * The pixels right of a crossing c start at x = ceil(c) = floor(c + 1 - 1 / (512 dy)), as c is a
 * multiple of 1 / (256 dy) px. In steps of 2^-46 px, rounded or cut off, the sum over up to 8,192 rows
 * is off by less than 2^-32 px, so its integer part is exact for dy up to 2^23 (twice the guard region).
 */
#include "path.h"

#include <math.h>

/* Loops over a multiple of eight: no remainder is worth a loop of its own. */
#define WHOLE_BLOCKS _Pragma("clang loop vectorize_width(8) interleave_count(1)")

enum { FRACTION = 46, MOST_ROWS = 8192, FEW_CLUSTERS = 16, BLOCK = 8, MOST_OF_TWO = 6, MOST_OF_THREE = 14 };

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

/* What n edges that cross rows reach. */
typedef struct {
    int32_t n, top, bottom, left, right;
} extent;

/* The steps that are worth their own code where there are lanes of 512 bits: to find edges, settle the
 * open ones, take their crossings and cover what lies inside. */
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

int32_t sm_draw_closed(const sm_body *body, int32_t segment, const eye *e, const double *a, sm_picture *picture,
                       sm_work *work) {
    sm_edges *edges = &work->edges;
    int32_t start = body->edge_starts[segment];
    if (start == body->edge_starts[segment + 1] || picture->height > MOST_ROWS) return 0;
    int32_t clusters = look_over(body, segment, e, work), open = 0, sure = find(body, start, clusters, e, &open, work);
    project(body, segment, a, work);
    sure = settle(body, e->front, sure, open, work);
    extent all = take(e->front, sure, picture, work);
    all.left = all.left < 0 ? 0 : all.left;
    all.right = all.right > picture->width ? picture->width : all.right;
    if (all.top >= all.bottom || all.left >= all.right) return 1;
    open_words(picture, all.left >> 6, ((all.right - 1) >> 6) + 1, all.top, all.bottom);
    return cover(&all, picture, edges);
}
