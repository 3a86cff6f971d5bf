/* Coverage of the segments of one view; compiled once per code path (SM_PATH, SM_PATH_NAME). */
#include "internal.h"

#include <string.h>

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

enum { HIDDEN, PLAIN, CLIPPED };
enum { MOST_CORNERS = 24 }; /* of a clipped triangle: half as many again with each of five planes */

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

static void homogeneous(const sm_body *body, const double *a, int32_t vertex, double *h) {
    double x = body->x[vertex], y = body->y[vertex], z = body->z[vertex];
    for (int i = 0; i < 3; i++) h[i] = a[4 * i] * x + a[4 * i + 1] * y + a[4 * i + 2] * z + a[4 * i + 3];
}

/* 1/256 px, to the nearest, ties to even: the low bits of a double of 52 fixed bits. */
static inline int32_t snap(double px) {
    double shifted = px * 256.0 + 6755399441055744.0;
    int64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    return (int32_t)bits;
}

static void snap_all(const sm_body *body, int32_t segment, const double *a, sm_work *work) {
    int32_t start = body->vertex_starts[segment], n = body->vertex_starts[segment + 1] - start;
    const float *restrict px = body->x + start, *restrict py = body->y + start, *restrict pz = body->z + start;
    int32_t *restrict qx = work->qx, *restrict qy = work->qy;
    double a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], b0 = a[4], b1 = a[5], b2 = a[6], b3 = a[7];
    double c0 = a[8], c1 = a[9], c2 = a[10], c3 = a[11];
    for (int32_t i = 0; i < n; i++) {
        double x = px[i], y = py[i], z = pz[i], w = 1.0 / (c0 * x + c1 * y + c2 * z + c3);
        qx[i] = snap((a0 * x + a1 * y + a2 * z + a3) * w);
        qy[i] = snap((b0 * x + b1 * y + b2 * z + b3) * w);
    }
}

/* Signed distances to the clipping planes in homogeneous px. */
static inline double inside(const double *h, int plane, double near) {
    switch (plane) {
        case 0: return h[2] - near;
        case 1: return SM_GUARD_PX * h[2] + h[0];
        case 2: return SM_GUARD_PX * h[2] - h[0];
        case 3: return SM_GUARD_PX * h[2] + h[1];
        default: return SM_GUARD_PX * h[2] - h[1];
    }
}

static int is_inside(const double *h, double near) {
    for (int plane = 0; plane < 5; plane++)
        if (!(inside(h, plane, near) >= 0.0)) return 0;
    return 1;
}

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

static inline void set_span(uint64_t *row, int32_t a, int32_t b) {
    if (a >= b) return;
    int32_t first = a >> 6, last = (b - 1) >> 6;
    uint64_t head = ~0ull << (a & 63), tail = ~0ull >> (63 - ((b - 1) & 63));
    if (first == last) {
        row[first] |= head & tail;
        return;
    }
    row[first] |= head;
    for (int32_t k = first + 1; k < last; k++) row[k] = ~0ull;
    row[last] |= tail;
}

/* Makes the rows from top to bottom part of the valid picture. */
static void open_rows(sm_work *work, int32_t words, int32_t top, int32_t bottom) {
    size_t width = (size_t)words;
    if (work->y0 >= work->y1) {
        work->y0 = work->y1 = top;
    }
    if (top < work->y0) {
        memset(work->rows + width * top, 0, width * 8 * (size_t)(work->y0 - top));
        work->y0 = top;
    }
    if (bottom > work->y1) {
        memset(work->rows + width * work->y1, 0, width * 8 * (size_t)(bottom - work->y1));
        work->y1 = bottom;
    }
}

static int64_t ceil_divided(int64_t a, int64_t b) { return a / b + (a % b > 0); } /* b > 0 */

static int32_t clamped(int64_t x, int32_t low, int32_t high) {
    return (int32_t)(x < low ? low : x > high ? high : x);
}

/* The pixels of a row right of the edge from (x0, y0) down to (x1, y1) start at ceil(crossing). */
static int32_t crossing(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row, int32_t width) {
    int64_t dy = y1 - y0, dx = x1 - x0;
    return clamped(ceil_divided(x0 * dy + (256 * (int64_t)row - y0) * dx, 256 * dy), 0, width);
}

static inline int32_t first_row(int32_t y) { return (y + 255) >> 8; }

static void fill_triangle(const int32_t *x, const int32_t *y, const sm_views *views, int32_t view,
                          int32_t top, int32_t bottom, sm_work *work) {
    int64_t area = (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
    int32_t low = y[0] < y[1] ? y[0] : y[1], high = y[0] < y[1] ? y[1] : y[0];
    low = clamped(first_row(y[2] < low ? y[2] : low), top, bottom);
    high = clamped(first_row(y[2] > high ? y[2] : high), top, bottom);
    if (area == 0 || low >= high) return;
    int32_t width = views->sizes[2 * view], words = (width + 63) >> 6;
    open_rows(work, words, low, high);
    for (int32_t row = low; row < high; row++) {
        int32_t ends[2], n = 0;
        for (int i = 0; i < 3; i++) {
            int a = i, b = (i + 1) % 3;
            if (y[a] > y[b]) a = b, b = i;
            if (y[a] > 256 * row || y[b] <= 256 * row) continue;
            ends[n++] = crossing(x[a], y[a], x[b], y[b], row, width);
        }
        int32_t left = ends[0] < ends[1] ? ends[0] : ends[1];
        set_span(work->rows + (size_t)words * row, left, ends[0] + ends[1] - left);
    }
}

/* The slow way: every triangle on its own, clipped. Same picture, no conditions. */
static void draw_triangles(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                           const double *a, int32_t top, int32_t bottom, sm_work *work) {
    int32_t start = body->vertex_starts[segment];
    for (int32_t f = body->face_starts[segment]; f < body->face_starts[segment + 1]; f++) {
        double polygon[MOST_CORNERS][3];
        int n = 3, clean = 1;
        for (int i = 0; i < 3; i++) {
            homogeneous(body, a, start + body->corners[3 * f + i], polygon[i]);
            clean &= is_inside(polygon[i], views->near);
        }
        if (!clean) n = clip(polygon, n, views->near);
        int32_t x[MOST_CORNERS], y[MOST_CORNERS];
        for (int i = 0; i < n; i++) {
            double w = 1.0 / polygon[i][2];
            x[i] = snap(polygon[i][0] * w);
            y[i] = snap(polygon[i][1] * w);
        }
        for (int i = 1; i + 1 < n; i++) {
            int32_t tx[3] = {x[0], x[i], x[i + 1]}, ty[3] = {y[0], y[i], y[i + 1]};
            fill_triangle(tx, ty, views, view, top, bottom, work);
        }
    }
}

/* Orientation of every face in the picture. */
static void find_signs(const sm_body *body, int32_t segment, sm_work *work) {
    int32_t start = body->face_starts[segment], n = body->face_starts[segment + 1] - start;
    const int32_t *corners = body->corners + 3 * (size_t)start, *qx = work->qx, *qy = work->qy;
    for (int32_t f = 0; f < n; f++) {
        int32_t i = corners[3 * f], j = corners[3 * f + 1], k = corners[3 * f + 2];
        int64_t area = (int64_t)(qx[j] - qx[i]) * (qy[k] - qy[i]) - (int64_t)(qx[k] - qx[i]) * (qy[j] - qy[i]);
        work->signs[f] = (int8_t)((area > 0) - (area < 0));
    }
    work->signs[n] = 0;
}

/* Records whose signed sum does not vanish, with that sum. */
static int32_t find_contour(const sm_body *body, int32_t segment, sm_work *work) {
    int32_t n = 0, *found = work->found;
    const int8_t *signs = work->signs;
    for (int32_t r = body->record_starts[segment]; r < body->record_starts[segment + 1]; r++) {
        const int32_t *faces = body->record_faces + 2 * (size_t)r;
        const int8_t *d = body->record_signs + 2 * (size_t)r;
        int32_t sum = signs[faces[0]] * d[0] + signs[faces[1]] * d[1];
        found[2 * n] = r;
        found[2 * n + 1] = sum;
        n += sum != 0;
    }
    return n;
}

typedef struct {
    int32_t top, bottom; /* rows touched */
    int32_t overflow;    /* a row had more crossings than slots */
} touched;

/* Enters the crossings of one edge into the slots of its rows. */
static inline void cross_rows(const int32_t *ends, int32_t sum, int32_t top, int32_t bottom, int32_t width,
                              sm_work *work, touched *t) {
    int32_t x0 = work->qx[ends[0]], y0 = work->qy[ends[0]], x1 = work->qx[ends[1]], y1 = work->qy[ends[1]];
    int32_t step = -sum; /* downward edges of a positive triangle are its right ones */
    if (y0 > y1) {
        int32_t swap = y0;
        y0 = y1, y1 = swap;
        swap = x0, x0 = x1, x1 = swap;
        step = sum;
    }
    int32_t row = first_row(y0) < top ? top : first_row(y0), end = first_row(y1) > bottom ? bottom : first_row(y1);
    if (row >= end) return;
    if (row < t->top) t->top = row;
    if (end > t->bottom) t->bottom = end;
    int64_t dy = y1 - y0, dx = x1 - x0, unit = 256 * dy, numerator = x0 * dy + (256 * (int64_t)row - y0) * dx;
    int64_t x = ceil_divided(numerator, unit), rest = x * unit - numerator;
    int64_t slope = dx / dy - (dx % dy < 0), turn = 256 * (slope * dy - dx);
    for (; row < end; row++) {
        int32_t n = work->counts[row];
        t->overflow |= n >= SM_SLOTS;
        work->slots[row * SM_SLOTS + (n & (SM_SLOTS - 1))] = clamped(x, 0, width) * 8 + step + 4;
        work->counts[row] = (uint8_t)(n < SM_SLOTS ? n + 1 : n);
        rest += turn;
        int64_t carry = rest >> 63;
        x += slope - carry;
        rest += unit & carry;
    }
}

/* Turns one row's crossings into spans of positive winding. */
static void fill_row(uint64_t *row, int32_t *slots, int32_t n) {
    if (n == 2) {
        int32_t a = slots[0] >> 3, b = slots[1] >> 3;
        set_span(row, a < b ? a : b, a < b ? b : a);
        return;
    }
    for (int32_t i = 1; i < n; i++) {
        int32_t value = slots[i], j = i - 1;
        for (; j >= 0 && slots[j] > value; j--) slots[j + 1] = slots[j];
        slots[j + 1] = value;
    }
    int32_t winding = 0, left = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t before = winding;
        winding += (slots[i] & 7) - 4;
        if (before <= 0 && winding > 0) left = slots[i] >> 3;
        if (before > 0 && winding <= 0) set_span(row, left, slots[i] >> 3);
    }
}

static void draw_segment(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                         const double *a, int32_t top, int32_t bottom, sm_work *work) {
    snap_all(body, segment, a, work);
    find_signs(body, segment, work);
    int32_t n = find_contour(body, segment, work), width = views->sizes[2 * view], words = (width + 63) >> 6;
    touched t = {bottom, top, 0};
    for (int32_t k = 0; k < n; k++)
        cross_rows(body->record_vertices + 2 * (size_t)work->found[2 * k], work->found[2 * k + 1], top, bottom,
                   width, work, &t);
    if (t.top >= t.bottom) return;
    if (t.overflow) {
        memset(work->counts + t.top, 0, (size_t)(t.bottom - t.top));
        draw_triangles(body, views, view, segment, a, top, bottom, work);
        return;
    }
    open_rows(work, words, t.top, t.bottom);
    for (int32_t row = t.top; row < t.bottom; row++) {
        fill_row(work->rows + (size_t)words * row, work->slots + row * SM_SLOTS, work->counts[row]);
        work->counts[row] = 0;
    }
}

static void draw(const sm_body *body, const sm_views *views, int32_t view, const int32_t *segments,
                 int32_t count, int32_t top, int32_t bottom, sm_work *work) {
    work->y0 = work->y1 = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t s = segments[k];
        const double *m = work->transforms + 12 * (size_t)body->segment_joints[s];
        int where = place(views, view, m, body->spheres + 4 * (size_t)s);
        if (where == HIDDEN) continue;
        double a[12];
        compose(views->projections + 12 * (size_t)view, m, a);
        (where == PLAIN ? draw_segment : draw_triangles)(body, views, view, s, a, top, bottom, work);
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

static int64_t sum(const sm_views *views, const sm_weights *weights, int32_t view, const sm_work *work) {
    int32_t width = views->sizes[2 * view], words = (width + 63) >> 6;
    size_t start = (size_t)words * work->y0, n = (size_t)words * (work->y1 - work->y0);
    if (weights->kind == SM_PLANES) {
        size_t at = (size_t)views->word_starts[view] + start;
        return sum_planes(work->rows + start, weights->plus + at, weights->minus + at, n);
    }
    int64_t total = 0;
    const int32_t *sums = weights->sums + views->sum_starts[view];
    for (int32_t y = work->y0; y < work->y1; y++)
        total += sum_spans(work->rows + (size_t)words * y, sums + (size_t)(width + 1) * y, words, width);
    return total;
}

static int32_t snap_checked(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                            sm_work *work) {
    double a[12], h[3];
    int32_t start = body->vertex_starts[segment], n = body->vertex_starts[segment + 1] - start, clean = 1;
    compose(views->projections + 12 * (size_t)view,
            work->transforms + 12 * (size_t)body->segment_joints[segment], a);
    snap_all(body, segment, a, work);
    for (int32_t i = 0; i < n; i++) {
        homogeneous(body, a, start + i, h);
        if (is_inside(h, views->near)) continue;
        work->qx[i] = work->qy[i] = INT32_MIN;
        clean = 0;
    }
    return clean;
}

const sm_path JOIN(sm_path_, SM_PATH) = {draw, sum, snap_checked};
