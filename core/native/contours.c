/* The fast way: only edges at which the signed sum of the neighbouring triangles does not vanish.
 *
 * Clusters of triangles, then single triangles, are judged by their planes. Twice the area of a
 * snapped triangle is, in steps of 1/256 px, 256^2 det K R N . (p - c) / (z1 z2 z3), give or take
 * d (|e1| + |e2| + |e3|) + 4 d^2, where d = 1/2 is the snapping and |e| the edges' length in steps (1-norm):
 * at most 256 sqrt 2 scale(K) sqrt(1 + t^2) / z of that in metres, t the tangent off the axis. What
 * lies within that margin is decided by its snapped area itself, so the result is always exact.
 */
#include "path.h"

#include <math.h>

enum { CHUNK = 256, GLANCES = 64 };

int32_t sm_glance(const float *planes, size_t stride, int32_t start, int32_t n, const eye *e, int32_t *wanted) {
    const float *restrict x = planes + start, *restrict y = x + stride, *restrict z = y + stride, *restrict d = z + stride;
    const float *restrict spread = d + stride, *restrict own = spread + stride, *restrict m1 = own + stride, *restrict m2 = m1 + stride;
    float ex = e->at[0], ey = e->at[1], ez = e->at[2], reach = e->reach, edge = e->edge, step = e->step, slack = e->slack;
    int32_t found = 0;
    for (int32_t first = 0; first < n; first += GLANCES) {
        int32_t count = n - first < GLANCES ? n - first : GLANCES;
        uint8_t known[GLANCES];
        for (int32_t c = 0; c < count; c++) {
            int32_t k = first + c;
            float side = x[k] * ex + y[k] * ey + z[k] * ez - d[k];
            known[c] = fabsf(side) > reach * spread[k] + own[k] + edge * m1[k] + step * m2[k] + slack;
        }
        for (int32_t c = 0; c < count; c++) {
            wanted[found] = start + first + c;
            found += !known[c];
        }
    }
    return found;
}

/* Which way every face looks, as far as its plane can tell. */
static void judge(const sm_body *body, int32_t segment, const eye *e, sm_work *work) {
    size_t faces = (size_t)body->clusters * SM_CLUSTER, start = (size_t)body->cluster_starts[segment] * SM_CLUSTER;
    int32_t n = SM_CLUSTER * body->cluster_starts[segment + 1] - (int32_t)start;
    const float *restrict x = body->face_planes + start, *restrict y = x + faces, *restrict z = y + faces;
    const float *restrict d = z + faces, *restrict m1 = d + faces, *restrict m2 = m1 + faces;
    float ex = e->at[0], ey = e->at[1], ez = e->at[2], edge = e->edge, step = e->step, slack = e->slack;
    uint8_t *restrict facing = work->facing;
    for (int32_t f = 0; f < n; f++) {
        float side = x[f] * ex + y[f] * ey + z[f] * ez - d[f], margin = edge * m1[f] + step * m2[f] + slack;
        facing[f] = (uint8_t)((side > margin) * FRONT + (side < -margin) * BACK);
    }
    facing[n] = NO_FACE;
    facing[n + 1] = FRONT;
}

/* Records between faces that are not known to look the same way; returns their number. */
static int32_t find_edges(const sm_body *body, int32_t runs, sm_work *work) {
    const int32_t *restrict starts = body->run_starts, *restrict wanted = work->runs;
    const uint8_t *restrict facing = work->facing;
    int32_t *restrict found = work->found, n = 0;
    for (int32_t k = 0; k < runs; k++) {
        int32_t r = starts[wanted[k]], end = starts[wanted[k] + 1];
        for (; r < end; r += SM_RUN) {
            const int32_t *restrict faces = body->record_faces + 2 * (size_t)r;
            for (int32_t i = 0; i < SM_RUN; i++) {
                found[n] = r + i;
                n += (facing[faces[2 * i]] & facing[faces[2 * i + 1]]) == 0;
            }
        }
    }
    return n;
}

/* Snaps the ends of the found edges, among them all corners of unknown faces. */
static void snap_ends(const sm_body *body, int32_t segment, const double *a, int32_t found, sm_work *work) {
    int32_t start = body->vertex_starts[segment], n = 0;
    int32_t *restrict places = work->places, *restrict wanted = work->wanted;
    memset(places, 0xff, sizeof *places * (size_t)(body->vertex_starts[segment + 1] - start));
    for (int32_t k = 0; k < found; k++) {
        const int32_t *ends = body->record_vertices + 2 * (size_t)work->found[k];
        for (int i = 0; i < 2; i++) {
            int32_t known = places[ends[i]];
            wanted[n] = ends[i];
            places[ends[i]] = known < 0 ? n : known;
            n += known < 0;
        }
    }
    const float *restrict px = body->x + start, *restrict py = body->y + start, *restrict pz = body->z + start;
    int32_t *restrict qx = work->qx, *restrict qy = work->qy;
    double a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], b0 = a[4], b1 = a[5], b2 = a[6], b3 = a[7];
    double c0 = a[8], c1 = a[9], c2 = a[10], c3 = a[11];
    for (int32_t i = 0; i < n; i++) {
        int32_t v = wanted[i];
        double x = px[v], y = py[v], z = pz[v], w = 1.0 / (c0 * x + c1 * y + c2 * z + c3);
        qx[i] = snap((a0 * x + a1 * y + a2 * z + a3) * w);
        qy[i] = snap((b0 * x + b1 * y + b2 * z + b3) * w);
    }
}

/* Settles the faces that planes left open, by their snapped areas. */
static void settle(const sm_body *body, int32_t segment, int32_t found, int32_t front, sm_work *work) {
    const int32_t *corners = body->corners + 3 * SM_CLUSTER * (size_t)body->cluster_starts[segment];
    const int32_t *qx = work->qx, *qy = work->qy, *places = work->places;
    int32_t n = 0;
    for (int32_t k = 0; k < found; k++) {
        const int32_t *faces = body->record_faces + 2 * (size_t)work->found[k];
        for (int i = 0; i < 2; i++) {
            int32_t open = work->facing[faces[i]] == UNKNOWN;
            work->unknown[n] = faces[i];
            work->facing[faces[i]] |= (uint8_t)(open * FLAT);
            n += open;
        }
    }
    for (int32_t u = 0; u < n; u++) {
        const int32_t *face = corners + 3 * (size_t)work->unknown[u];
        int32_t i = places[face[0]], j = places[face[1]], k = places[face[2]];
        if ((i | j | k) < 0) continue; /* planes that contradict each other: no body of ours */
        int64_t area = (int64_t)(qx[j] - qx[i]) * (qy[k] - qy[i]) - (int64_t)(qx[k] - qx[i]) * (qy[j] - qy[i]);
        area *= front;
        work->facing[work->unknown[u]] = (uint8_t)(area > 0 ? FRONT : area < 0 ? BACK : FLAT);
    }
}

/* Edges from above to below, a chunk at a time. */
typedef struct {
    int32_t n, top, bottom, overflow; /* edges; rows touched; a row had more crossings than slots */
    int32_t x0[CHUNK], y0[CHUNK], x1[CHUNK], y1[CHUNK], row[CHUNK], end[CHUNK], step[CHUNK];
    int32_t x[CHUNK], rest[CHUNK], slope[CHUNK], turn[CHUNK], unit[CHUNK];
} edges;

/* The first crossing's pixel x = ceil(crossing) with rest = x - crossing, and what both grow by from
 * row to row, rests in units of 1 / (256 dy). Doubles hold all these integers exactly. */
static void prepare_edges(edges *restrict e) {
    const double round = 6755399441055744.0;
    for (int32_t i = 0; i < e->n; i++) {
        double x0 = e->x0[i], dx = e->x1[i] - x0, dy = e->y1[i] - e->y0[i], unit = 256.0 * dy;
        double crossing = x0 * dy + (256.0 * e->row[i] - e->y0[i]) * dx;
        double x = (crossing / unit + round) - round, rest = x * unit - crossing;
        x += rest < 0.0 ? 1.0 : 0.0;
        rest += rest < 0.0 ? unit : 0.0;
        double slope = (dx / dy + round) - round, turn = slope * dy - dx;
        slope -= turn > 0.0 ? 1.0 : 0.0;
        turn -= turn > 0.0 ? dy : 0.0;
        e->x[i] = (int32_t)x;
        e->rest[i] = (int32_t)rest;
        e->slope[i] = (int32_t)slope;
        e->turn[i] = (int32_t)(256.0 * turn);
        e->unit[i] = (int32_t)unit;
    }
}

/* Enters all crossings of a chunk into the slots of their rows. */
static void cross_rows(edges *e, int32_t width, sm_work *work) {
    prepare_edges(e);
    uint8_t *restrict counts = work->counts;
    int32_t *restrict slots = work->slots, overflow = 0;
    for (int32_t i = 0; i < e->n; i++) {
        int32_t x = e->x[i], rest = e->rest[i], slope = e->slope[i], turn = e->turn[i], unit = e->unit[i];
        int32_t code = e->step[i] + 4, end = e->end[i];
        for (int32_t row = e->row[i]; row < end; row++) {
            int32_t n = counts[row], column = x < 0 ? 0 : x > width ? width : x;
            overflow |= n >= SM_SLOTS;
            slots[row * SM_SLOTS + (n & (SM_SLOTS - 1))] = column * 8 + code;
            counts[row] = (uint8_t)(n + (n < SM_SLOTS));
            rest += turn;
            int32_t carry = rest >> 31;
            x += slope - carry;
            rest += unit & carry;
        }
    }
    e->overflow |= overflow;
    e->n = 0;
}

/* Takes up to a chunk of the contour's edges, those that cross rows. */
static void take_edges(const sm_body *body, int32_t first, int32_t last, const sm_picture *picture, edges *e,
                       sm_work *work) {
    int32_t top = picture->top, bottom = picture->bottom;
    const int32_t *qx = work->qx, *qy = work->qy;
    for (int32_t k = first; k < last; k++) {
        const int32_t *ends = body->record_vertices + 2 * (size_t)work->found[k];
        int32_t p = work->places[ends[0]], q = work->places[ends[1]], i = e->n, sum = work->unknown[k];
        int32_t up = qy[p] > qy[q], above = up ? q : p, below = up ? p : q;
        int32_t row = first_row(qy[above]), end = first_row(qy[below]);
        row = row < top ? top : row;
        end = end > bottom ? bottom : end;
        e->x0[i] = qx[above];
        e->y0[i] = qy[above];
        e->x1[i] = qx[below];
        e->y1[i] = qy[below];
        e->row[i] = row;
        e->end[i] = end;
        e->step[i] = up ? sum : -sum; /* downward edges of a positive triangle are its right ones */
        int32_t drawn = row < end;
        e->top = (drawn & (row < e->top)) ? row : e->top;
        e->bottom = (drawn & (end > e->bottom)) ? end : e->bottom;
        e->n += drawn;
    }
}

/* Turns one row's crossings into spans of positive winding. */
static void fill_row(const sm_picture *picture, int32_t row, int32_t *slots, int32_t n) {
    if (n == 2) {
        int32_t a = slots[0] >> 3, b = slots[1] >> 3;
        set_span(picture, row, a < b ? a : b, a < b ? b : a);
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
        if (before > 0 && winding <= 0) set_span(picture, row, left, slots[i] >> 3);
    }
}

int32_t sm_find_contour(const sm_body *body, int32_t segment, const eye *e, const double *a, sm_work *work) {
    int32_t start = body->cluster_starts[segment], n = body->cluster_starts[segment + 1] - start, drawn = 0;
    int32_t runs = sm_glance(body->cluster_planes, (size_t)body->clusters, start, n, e, work->runs);
    if (!runs) return 0;
    judge(body, segment, e, work);
    int32_t found = find_edges(body, runs, work);
    snap_ends(body, segment, a, found, work);
    settle(body, segment, found, e->front, work);
    const int32_t sign_of[5] = {0, e->front, -e->front, 0, 0};
    for (int32_t k = 0; k < found; k++) {
        const int32_t *faces = body->record_faces + 2 * (size_t)work->found[k];
        int32_t sum = sign_of[work->facing[faces[0]]] - sign_of[work->facing[faces[1]]];
        work->found[drawn] = work->found[k];
        work->unknown[drawn] = sum;
        drawn += sum != 0;
    }
    return drawn;
}

int32_t sm_draw_contours(const sm_body *body, int32_t segment, const eye *e, const double *a, sm_picture *picture,
                         sm_work *work) {
    int32_t found = sm_find_contour(body, segment, e, a, work);
    edges drawn;
    drawn.n = drawn.overflow = 0;
    drawn.top = picture->bottom, drawn.bottom = picture->top;
    for (int32_t k = 0; k < found; k += CHUNK) {
        int32_t count = found - k < CHUNK ? found - k : CHUNK;
        take_edges(body, k, k + count, picture, &drawn, work);
        cross_rows(&drawn, picture->width, work);
    }
    if (drawn.top >= drawn.bottom) return 1;
    if (drawn.overflow) {
        memset(work->counts + drawn.top, 0, (size_t)(drawn.bottom - drawn.top));
        return 0;
    }
    open_words(picture, 0, picture->words, drawn.top, drawn.bottom);
    for (int32_t row = drawn.top; row < drawn.bottom; row++) {
        fill_row(picture, row, work->slots + row * SM_SLOTS, work->counts[row]);
        work->counts[row] = 0;
    }
    return 1;
}
