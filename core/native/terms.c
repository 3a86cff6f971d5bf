/* Normal equations that draw the points of outlines towards observed contours, and the contours' points
 * towards the outlines.
 *
 * A point X that a joint carries moves by v + w x X with the joint's twist (v, w), and its image by du/dX
 * times that; so its distance along a direction g of the image changes by l = (a, X x a), a = g du/dX.
 * Robust weights are those of Geman and McClure: rho = c^2 r^2 / (c^2 + r^2), w = (c^2 / (c^2 + r^2))^2.
 */
#include "path.h"

#include <math.h>

#define FAR 1e18f /* px, beyond any picture; its square is finite */
enum { ROW = 8, COST = 6 * ROW, COUNT, BLOCK = SM_BLOCK };

/* One view: where its camera and the joints stand, and its part of the sums. */
typedef struct {
    const double *projection, *transforms;
    double metres, reach;
    double *out;
} view_terms;

/* Adds a residual of r px along g at a point (joint's space) seen at px: w l (l, r)'. */
static void add(const view_terms *v, int32_t joint, const double *point, const double *px, const double *g, double r, double share) {
    const double *m = v->transforms + 12 * (size_t)joint, *p = v->projection;
    double x[3], a[3], row[ROW] = {0};
    for (int i = 0; i < 3; i++) x[i] = m[4 * i] * point[0] + m[4 * i + 1] * point[1] + m[4 * i + 2] * point[2] + m[4 * i + 3];
    double scale = v->metres / (p[8] * x[0] + p[9] * x[1] + p[10] * x[2] + p[11]);
    for (int i = 0; i < 3; i++) row[i] = a[i] = scale * (g[0] * (p[i] - px[0] * p[8 + i]) + g[1] * (p[4 + i] - px[1] * p[8 + i]));
    row[3] = x[1] * a[2] - x[2] * a[1];
    row[4] = x[2] * a[0] - x[0] * a[2];
    row[5] = x[0] * a[1] - x[1] * a[0];
    row[6] = r *= v->metres;
    double c = v->reach * v->reach, robust = c / (c + r * r), w = share * robust * robust;
    double *restrict out = v->out + SM_TERMS * (size_t)joint;
    /* not across rows, which would scatter */
#pragma clang loop vectorize(disable)
    for (int i = 0; i < 6; i++) {
        double weighed = w * row[i];
        for (int j = 0; j < ROW; j++) out[ROW * i + j] += weighed * row[j];
    }
    out[COST] += share * robust * r * r;
    out[COUNT] += 1.0;
}

/* The field at a place between four pixels' centres, and how it grows; 0 where it is not known. */
static int look_up(const float *field, int32_t width, int32_t height, const double *px, double *value, double *slope) {
    double fx = floor(px[0]), fy = floor(px[1]);
    if (!(fx >= 0.0 && fy >= 0.0 && fx < width - 1 && fy < height - 1)) return 0;
    const float *f = field + (size_t)fy * (size_t)width + (size_t)fx;
    double x = px[0] - fx, y = px[1] - fy, a = f[0], b = f[1], c = f[width], d = f[width + 1];
    slope[0] = (b - a) * (1.0 - y) + (d - c) * y;
    slope[1] = (c - a) * (1.0 - x) + (d - b) * x;
    *value = (a * (1.0 - x) + b * x) * (1.0 - y) + (c * (1.0 - x) + d * x) * y;
    return !isnan(*value);
}

/* Of n points (4, n), n a multiple of BLOCK, the one nearest to a place in px and turned normals; px^2 goes to
 * `apart`. */
static int64_t nearest(const float *points, int64_t n, float x, float y, float nx, float ny, float *apart) {
    int64_t found = -1;
    int32_t least = INT32_MAX; /* floats of at least 0 are ordered as their bits */
    for (int64_t first = 0; first < n; first += BLOCK) {
        const float *restrict px = points + first, *restrict py = px + n, *restrict pnx = py + n, *restrict pny = pnx + n;
        float distances[BLOCK];
        int32_t bits[BLOCK], best = INT32_MAX;
        for (int i = 0; i < BLOCK; i++) {
            float a = px[i] - x, b = py[i] - y, c = pnx[i] - nx, d = pny[i] - ny;
            distances[i] = a * a + b * b + c * c + d * d;
        }
        memcpy(bits, distances, sizeof bits);
        for (int i = 0; i < BLOCK; i++) best = bits[i] < best ? bits[i] : best;
        if (best >= least) continue;
        least = best;
        for (found = first; bits[found - first] != best;) found++;
    }
    memcpy(apart, &least, sizeof least);
    return found;
}

/* From the outline's points to the contour, along the field. */
static void towards_contour(const sm_targets *t, int32_t view, const sm_points *points, const int32_t *joints, const view_terms *v) {
    const float *field = t->fields[view];
    int32_t width = t->sizes[2 * view], height = t->sizes[2 * view + 1];
    for (int64_t i = points->starts[view]; i < points->starts[view + 1]; i++) {
        double value, slope[2];
        const double *px = points->px + 2 * i, *normal = points->normals + 2 * i;
        if (!look_up(field, width, height, px, &value, slope)) continue;
        double along = slope[0] * normal[0] + slope[1] * normal[1];
        if (along > 0.3) add(v, joints[points->segments[i]], points->points + 3 * i, px, slope, value, along);
    }
}

/* From the contour's points to the nearest ones of the outline that look the same way. */
static void towards_outline(const sm_targets *t, int32_t view, const sm_points *points, const int32_t *joints, const view_terms *v,
                            float *scratch) {
    int64_t begin = points->starts[view], count = points->starts[view + 1] - begin, n = (count + BLOCK - 1) / BLOCK * BLOCK;
    float turn = (float)(t->turn / v->metres), most = (float)(3.0 * v->reach / v->metres);
    for (int64_t i = 0; i < count; i++) {
        const double *px = points->px + 2 * (begin + i), *normal = points->normals + 2 * (begin + i);
        scratch[i] = (float)px[0], scratch[n + i] = (float)px[1];
        scratch[2 * n + i] = turn * (float)normal[0], scratch[3 * n + i] = turn * (float)normal[1];
    }
    for (int64_t i = count; i < n; i++) scratch[i] = scratch[n + i] = scratch[2 * n + i] = scratch[3 * n + i] = FAR;
    for (int64_t k = t->starts[view]; k < t->starts[view + 1]; k++) {
        const float *at = t->px + 2 * k, *normal = t->normals + 2 * k;
        float apart;
        int64_t i = nearest(scratch, n, at[0], at[1], turn * normal[0], turn * normal[1], &apart);
        if (i < 0 || apart > most * most) continue;
        i += begin;
        double g[2] = {normal[0], normal[1]}, *px = points->px + 2 * i;
        double r = (px[0] - at[0]) * g[0] + (px[1] - at[1]) * g[1];
        add(v, joints[points->segments[i]], points->points + 3 * i, px, g, r, 1.0);
    }
}

void sm_add_terms(const sm_targets *t, const sm_points *points, const double *transforms, const int32_t *segment_joints,
                  int32_t joints, double *out, float *scratch) {
    for (int32_t view = 0; view < t->views; view++) {
        view_terms v = {t->projections + 12 * (size_t)view, transforms, t->metres[view], t->reach,
                        out + SM_TERMS * (size_t)joints * (size_t)view};
        if (t->starts[view] == t->starts[view + 1]) continue;
        towards_contour(t, view, points, segment_joints, &v);
        towards_outline(t, view, points, segment_joints, &v, scratch);
    }
}
