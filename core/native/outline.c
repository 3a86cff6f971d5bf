/* Points on the outline: contour edges in even steps, where nothing covers the pixel beside them. */
#include "path.h"

#include <math.h>

#define BESIDE 0.75 /* px: just over half a pixel's diagonal, so that its centre lies beyond a straight edge */

static int is_covered(const sm_picture *picture, int32_t x, int32_t y) {
    const int32_t *range = picture->ranges + 2 * (x >> 6);
    if (y < range[0] || y >= range[1]) return 0;
    return picture->bits[(size_t)picture->height * (size_t)(x >> 6) + (size_t)y] >> (x & 63) & 1;
}

/* Depth of a vertex in homogeneous px. */
static double depth(const sm_body *body, const double *a, int32_t vertex) {
    double h[3];
    homogeneous(body, a, vertex, h);
    return h[2];
}

static void put(const sm_body *body, int32_t segment, const int32_t *ends, double along, const double *px,
                const double *normal, int64_t n, sm_points *out) {
    const float *axes[3] = {body->x, body->y, body->z};
    for (int i = 0; i < 3; i++) {
        double p = axes[i][ends[0]], q = axes[i][ends[1]];
        out->points[3 * n + i] = p + along * (q - p);
    }
    for (int i = 0; i < 2; i++) {
        out->px[2 * n + i] = px[i];
        out->normals[2 * n + i] = normal[i];
    }
    out->segments[n] = segment;
}

/* Samples the k-th of the edges found; returns how many points there are then. */
static int64_t sample(const sm_body *body, int32_t segment, int32_t k, const double *a, double spacing,
                      const sm_picture *picture, const sm_work *work, int64_t n, sm_points *out) {
    const int32_t *own = body->record_vertices + 2 * (size_t)work->found[k];
    int32_t start = body->vertex_starts[segment], ends[2] = {start + own[0], start + own[1]};
    int32_t p = work->places[own[0]], q = work->places[own[1]];
    double x = work->qx[p] / 256.0, y = work->qy[p] / 256.0, dx = work->qx[q] / 256.0 - x, dy = work->qy[q] / 256.0 - y;
    double length = sqrt(dx * dx + dy * dy), steps = ceil(length / spacing), side = work->unknown[k] > 0 ? 1.0 : -1.0;
    double near = depth(body, a, ends[0]), far = depth(body, a, ends[1]), normal[2] = {side * dy / length, -side * dx / length};
    for (double i = 0.5; i < steps; i += 1.0) {
        double t = i / steps, px[2] = {x + t * dx, y + t * dy};
        double u = floor(px[0] + BESIDE * normal[0] + 0.5), v = floor(px[1] + BESIDE * normal[1] + 0.5);
        if (!(u >= 0.0 && v >= 0.0 && u < picture->width && v < picture->height)) continue;
        if (is_covered(picture, (int32_t)u, (int32_t)v)) continue;
        if (n < out->room) put(body, segment, ends, (t / far) / ((1.0 - t) / near + t / far), px, normal, n, out);
        n++;
    }
    return n;
}

static int64_t sample_segment(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                              double spacing, int64_t n, sm_points *out, sm_work *work) {
    double a[12];
    sm_see(body, views, segment, work);
    if (work->sight.where[view] != PLAIN) return n;
    eye e = sm_eye(views, view, &work->sight, a);
    int32_t found = sm_find_contour(body, segment, &e, a, work);
    for (int32_t k = 0; k < found; k++)
        n = sample(body, segment, k, a, spacing, work->pictures + view, work, n, out);
    return n;
}

/* Points of a skinned segment from the world into the space of the joint that carries it. */
static void carry_back(const double *m, int32_t segment, int64_t begin, int64_t end, sm_points *out) {
    for (int64_t i = begin; i < end && i < out->room; i++) {
        double *p = out->points + 3 * i, d[3] = {p[0] - m[3], p[1] - m[7], p[2] - m[11]};
        for (int j = 0; j < 3; j++) p[j] = m[j] * d[0] + m[4 + j] * d[1] + m[8 + j] * d[2];
        out->segments[i] = segment;
    }
}

void sm_outlines(const sm_body *body, const sm_views *views, const int32_t *segments, int32_t count, double spacing,
                 sm_points *out, sm_work *work) {
    int64_t n = 0;
    for (int32_t view = 0; view < views->views; view++) {
        out->starts[view] = n;
        for (int32_t s = 0; s < count; s++) {
            sm_work own = *work;
            int64_t begin = n;
            int skinned = body->skinned[segments[s]];
            const sm_body *posed = skinned ? sm_posed(body, view, segments[s], work, &own) : body;
            n = sample_segment(posed, views, view, skinned ? 0 : segments[s], spacing, n, out, &own);
            if (skinned) carry_back(sm_transform(body, work, view, segments[s]), segments[s], begin, n, out);
        }
    }
    out->starts[views->views] = n;
}
