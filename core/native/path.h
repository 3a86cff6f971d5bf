/* What the files that are compiled once per code path (SM_PATH) share. */
#ifndef SM_PATH_H
#define SM_PATH_H

#include "internal.h"

#include <string.h>

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define PATH(name) JOIN(name, SM_PATH)
#define sm_draw_contours PATH(sm_draw_contours_)
#define sm_draw_triangles PATH(sm_draw_triangles_)
#define sm_draw_closed PATH(sm_draw_closed_)
#define sm_glance PATH(sm_glance_)
#define sm_see PATH(sm_see_)
#define sm_posed PATH(sm_posed_)
#define sm_find_contour PATH(sm_find_contour_)
#define sm_outlines PATH(sm_outlines_)
#define sm_add_terms PATH(sm_add_terms_)

/* One of the views of sm_sight. */
typedef struct {
    float at[3], reach, edge, step, slack;
    int32_t front;
} eye;

/* Draws a segment that lies in the guard region as a whole, by its contours; `a` carries joint's
 * metres to homogeneous px. Returns 0, with nothing drawn, where a row has too many crossings. */
int32_t sm_draw_contours(const sm_body *, int32_t segment, const eye *, const double *a, sm_picture *, sm_work *);

/* The same for a closed segment, faster. Returns 0, with nothing or a part of it drawn, where it is not
 * closed, overlaps itself too often, or the picture is too high. */
int32_t sm_draw_closed(const sm_body *, int32_t segment, const eye *, const double *a, sm_picture *, sm_work *);

/* The clusters from `start` on, of n, whose faces are not all known to look the same way, go into
 * `wanted`; returns their number. `planes` (8, stride) are those of sm_body. */
int32_t sm_glance(const float *planes, size_t stride, int32_t start, int32_t n, const eye *, int32_t *wanted);

/* A skinned segment, posed as one view sees it, as the one segment of a body, to be drawn with `own`. */
const sm_body *sm_posed(const sm_body *, int32_t view, int32_t segment, const sm_work *, sm_work *own);

/* Fills work->sight with what all views see of a segment. */
void sm_see(const sm_body *, const sm_views *, int32_t segment, sm_work *);

/* The part of work->sight that one view has; `a` (12) carries joint's metres to homogeneous px. */
static inline eye sm_eye(const sm_views *views, int32_t view, const sm_sight *sight, double *a) {
    size_t lanes = sm_lanes(views), v = (size_t)view;
    for (size_t k = 0; k < 12; k++) a[k] = sight->a[k * lanes + v];
    return (eye){{sight->at[0][v], sight->at[1][v], sight->at[2][v]}, sight->reach[v], sight->edge[v],
                 sight->step[v], sight->slack[v], sight->front[v]};
}

/* Edges of a segment that lies in the guard region where the signed sum of the triangles on both
 * sides, in work->unknown, is not 0: records in work->found; returns their number. Both ends lie at
 * work->places in work->qx and qy. */
int32_t sm_find_contour(const sm_body *, int32_t segment, const eye *, const double *a, sm_work *);

/* Points on the outline of what has been drawn. */
void sm_outlines(const sm_body *, const sm_views *, const int32_t *segments, int32_t count, double spacing,
                 sm_points *out, sm_work *);

/* Adds what sm_contour_terms sums up. */
void sm_add_terms(const sm_targets *, const sm_points *, const double *transforms, const int32_t *segment_joints,
                  int32_t joints, double *out, float *scratch);

/* Draws any segment, every triangle on its own, clipped: slow, the same picture, no conditions. */
void sm_draw_triangles(const sm_body *, double near, int32_t segment, const double *a, sm_picture *);

static inline void homogeneous(const sm_body *body, const double *a, int32_t vertex, double *h) {
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

static inline int is_inside(const double *h, double near) {
    for (int plane = 0; plane < 5; plane++)
        if (!(inside(h, plane, near) >= 0.0)) return 0;
    return 1;
}

/* Sets the bits from column a to b (exclusive) of a row. */
static inline void set_span(const sm_picture *picture, int32_t row, int32_t a, int32_t b) {
    if (a >= b) return;
    int32_t first = a >> 6, last = (b - 1) >> 6;
    size_t height = (size_t)picture->height;
    uint64_t head = ~0ull << (a & 63), tail = ~0ull >> (63 - ((b - 1) & 63)), *word = picture->bits + height * (size_t)first + row;
    if (first == last) {
        *word |= head & tail;
        return;
    }
    *word |= head;
    for (int32_t k = first + 1; k < last; k++) *(word += height) = ~0ull;
    *(word + height) |= tail;
}

/* Makes the rows from top to bottom of the columns of words from first to last (exclusive) valid. */
static inline void open_words(sm_picture *picture, int32_t first, int32_t last, int32_t top, int32_t bottom) {
    for (int32_t k = first; k < last; k++) {
        int32_t *range = picture->ranges + 2 * k;
        uint64_t *column = picture->bits + (size_t)picture->height * (size_t)k;
        if (range[0] >= range[1]) range[0] = range[1] = top;
        if (top < range[0]) {
            memset(column + top, 0, 8 * (size_t)(range[0] - top));
            range[0] = top;
        }
        if (bottom > range[1]) {
            memset(column + range[1], 0, 8 * (size_t)(bottom - range[1]));
            range[1] = bottom;
        }
    }
}

/* First row whose pixel centres lie at or below a snapped y. */
static inline int32_t first_row(int32_t y) { return (y + 255) >> 8; }

#endif
