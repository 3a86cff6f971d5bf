/* Segments that leave the guard region, or overlap themselves too often for the contours' slots. */
#include "path.h"

#include <math.h>

enum { MOST_CORNERS = 24 }; /* of a clipped triangle: half as many again with each of five planes */

/* Sutherland-Hodgman; cuts are computed from the inner point outwards, so that neighbours agree. */
static int clip(double (*polygon)[3], int n, double near) {
    double out[MOST_CORNERS][3];
    for (int plane = 0; plane < 5 && n; plane++) {
        int m = 0;
        for (int i = 0; i < n; i++) {
            const double *a = polygon[i], *b = polygon[(i + 1) % n];
            double da = inside(a, plane, near), db = inside(b, plane, near);
            if (da >= 0.0) memcpy(out[m++], a, sizeof out[0]);
            if ((da >= 0.0) == (db >= 0.0)) continue;
            const double *in = da >= 0.0 ? a : b, *off = da >= 0.0 ? b : a;
            double d = da >= 0.0 ? da : db, e = da >= 0.0 ? db : da, t = d / (d - e);
            for (int k = 0; k < 3; k++) out[m][k] = in[k] + t * (off[k] - in[k]);
            m++;
        }
        n = m;
        memcpy(polygon, out, sizeof out[0] * (size_t)n);
    }
    return n;
}

/* What is cut off so far away that the cut is rounded to anywhere must not overflow. */
static double bounded(double px) { return fmin(fmax(px, -2.0 * SM_GUARD_PX), 2.0 * SM_GUARD_PX); }

static int64_t ceil_divided(int64_t a, int64_t b) { return a / b + (a % b > 0); } /* b > 0 */

static int32_t clamped(int64_t x, int32_t low, int32_t high) {
    return (int32_t)(x < low ? low : x > high ? high : x);
}

/* The pixels of a row right of the edge from (x0, y0) down to (x1, y1) start at ceil(crossing). */
static int32_t crossing(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row, int32_t width) {
    int64_t dy = y1 - y0, dx = x1 - x0;
    return clamped(ceil_divided(x0 * dy + (256 * (int64_t)row - y0) * dx, 256 * dy), 0, width);
}

static void fill_triangle(const int32_t *x, const int32_t *y, sm_picture *picture) {
    int64_t area = (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
    int32_t low = y[0] < y[1] ? y[0] : y[1], high = y[0] < y[1] ? y[1] : y[0];
    low = clamped(first_row(y[2] < low ? y[2] : low), picture->top, picture->bottom);
    high = clamped(first_row(y[2] > high ? y[2] : high), picture->top, picture->bottom);
    if (area == 0 || low >= high) return;
    open_words(picture, 0, picture->words, low, high);
    for (int32_t row = low; row < high; row++) {
        int32_t ends[2], n = 0;
        for (int i = 0; i < 3; i++) {
            int a = i, b = (i + 1) % 3;
            if (y[a] > y[b]) a = b, b = i;
            if (y[a] > 256 * row || y[b] <= 256 * row) continue;
            ends[n++] = crossing(x[a], y[a], x[b], y[b], row, picture->width);
        }
        int32_t left = ends[0] < ends[1] ? ends[0] : ends[1];
        set_span(picture, row, left, ends[0] + ends[1] - left);
    }
}

void sm_draw_triangles(const sm_body *body, double near, int32_t segment, const double *a,
                       sm_picture *picture) {
    int32_t start = body->vertex_starts[segment];
    int32_t end = SM_CLUSTER * body->cluster_starts[segment + 1];
    for (int32_t f = SM_CLUSTER * body->cluster_starts[segment]; f < end; f++) {
        double polygon[MOST_CORNERS][3];
        int n = 3, clean = 1;
        for (int i = 0; i < 3; i++) {
            homogeneous(body, a, start + body->corners[3 * f + i], polygon[i]);
            clean &= is_inside(polygon[i], near);
        }
        if (!clean) n = clip(polygon, n, near);
        int32_t x[MOST_CORNERS], y[MOST_CORNERS];
        for (int i = 0; i < n; i++) {
            double w = 1.0 / polygon[i][2];
            x[i] = snap(bounded(polygon[i][0] * w));
            y[i] = snap(bounded(polygon[i][1] * w));
        }
        for (int i = 1; i + 1 < n; i++) {
            int32_t tx[3] = {x[0], x[i], x[i + 1]}, ty[3] = {y[0], y[i], y[i + 1]};
            fill_triangle(tx, ty, picture);
        }
    }
}

