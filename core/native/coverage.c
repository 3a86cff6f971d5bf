/* One candidate: where segments lie in all views, how they are drawn, and what a picture weighs. */
#include "path.h"

#include <math.h>

enum { L = SM_LANES };

/* Joint's metres to homogeneous px, and where the sphere lies, for the L views from `view` on. Spheres
 * are only ever a short cut: no result depends on them. */
static void locate(const sm_views *views, size_t lanes, size_t view, const double (*restrict m)[L],
                   const double (*restrict centre)[L], double radius, sm_sight *sight) {
    const double *restrict p = views->projections + view, *restrict planes = views->planes + view;
    double *restrict a = sight->a + view;
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 4; j++) {
            double *restrict out = a + (4 * i + j) * lanes;
            const double *restrict row = p + 4 * i * lanes;
            for (int v = 0; v < L; v++)
                out[v] = row[v] * m[j][v] + row[lanes + v] * m[4 + j][v] + row[2 * lanes + v] * m[8 + j][v];
            for (int v = 0; v < L && j == 3; v++) out[v] += row[3 * lanes + v];
        }
    }
    double guard[L], picture[L];
    for (int v = 0; v < L; v++) guard[v] = picture[v] = INFINITY;
    for (size_t k = 0; k < 9; k++) {
        const double *restrict plane = planes + 4 * k * lanes;
        for (int v = 0; v < L; v++) {
            double d = plane[v] * centre[0][v] + plane[lanes + v] * centre[1][v] + plane[2 * lanes + v] * centre[2][v] + plane[3 * lanes + v];
            picture[v] = d < picture[v] ? d : picture[v];
            if (k < 5) guard[v] = d < guard[v] ? d : guard[v];
        }
    }
    for (int v = 0; v < L; v++) {
        /* so far from the origin that it is rounded away, or nowhere at all, nothing is plain */
        double doubt = 1e-12 * (fabs(centre[0][v]) + fabs(centre[1][v]) + fabs(centre[2][v]));
        sight->where[view + (size_t)v] = picture[v] < -radius ? HIDDEN : guard[v] > radius + doubt ? PLAIN : CLIPPED;
    }
}

/* What is needed to judge faces by their planes; see contours.c. */
static void look(const sm_views *views, size_t lanes, size_t view, const double (*restrict m)[L],
                 const double (*restrict centre)[L], double radius, double own, sm_sight *sight) {
    const double *restrict optics = views->optics + view, *restrict axis = views->projections + 8 * lanes + view;
    for (size_t j = 0; j < 3; j++) {
        float *restrict at = sight->at[j] + view;
        for (int v = 0; v < L; v++)
            at[v] = (float)(m[j][v] * (optics[v] - m[3][v]) + m[4 + j][v] * (optics[lanes + v] - m[7][v]) +
                            m[8 + j][v] * (optics[2 * lanes + v] - m[11][v]));
    }
    float *restrict reach = sight->reach + view, *restrict edge = sight->edge + view, *restrict step = sight->step + view;
    float *restrict slack = sight->slack + view;
    double distance[L], metres[L], steps[L];
    for (int v = 0; v < L; v++) {
        double x = centre[0][v], y = centre[1][v], z = centre[2][v];
        double dx = x - optics[v], dy = y - optics[lanes + v], dz = z - optics[2 * lanes + v];
        double depth = axis[v] * x + axis[lanes + v] * y + axis[2 * lanes + v] * z + axis[3 * lanes + v];
        double square = dx * dx + dy * dy + dz * dz, side = square - depth * depth;
        double near = depth - radius, far = depth + radius, tangent = (sqrt(side > 0.0 ? side : 0.0) + radius) / near;
        distance[v] = sqrt(square) + radius;
        metres[v] = far * far * far / (65536.0 * fabs(optics[3 * lanes + v])) * (1.0 + 1e-4);
        steps[v] = 256.0 * 1.41422 * optics[4 * lanes + v] * sqrt(1.0 + tangent * tangent) / near;
    }
    const double half = 0.5 + 1e-3;
    for (int v = 0; v < L; v++) {
        reach[v] = (float)(distance[v] * (1.0 + 1e-4));
        edge[v] = (float)(metres[v] * half * steps[v]);
        step[v] = (float)(metres[v] * 4.0 * half * half);
        slack[v] = (float)(2e-6 * (distance[v] + 2.0 * own));
    }
    for (int v = 0; v < L; v++) sight->front[view + (size_t)v] = optics[3 * lanes + v] > 0.0 ? -1 : 1;
}

void sm_see(const sm_body *body, const sm_views *views, int32_t segment, sm_work *work) {
    const double *sphere = body->spheres + 4 * (size_t)segment, *transform = sm_transform(body, work, 0, segment);
    double radius = sphere[3] * (1.0 + 1e-6) + 1e-9;
    double own = sqrt(sphere[0] * sphere[0] + sphere[1] * sphere[1] + sphere[2] * sphere[2]);
    size_t lanes = sm_lanes(views);
    for (size_t view = 0; view < lanes; view += L) {
        double m[12][L], centre[3][L];
        for (size_t k = 0; k < 12 && !work->stride; k++)
            for (int v = 0; v < L; v++) m[k][v] = transform[k];
        for (size_t v = 0; v < L && work->stride; v++) {
            size_t own_view = view + v < (size_t)views->views ? view + v : 0;
            for (size_t k = 0; k < 12; k++) m[k][v] = transform[work->stride * own_view + k];
        }
        for (int i = 0; i < 3; i++)
            for (int v = 0; v < L; v++)
                centre[i][v] = m[4 * i][v] * sphere[0] + m[4 * i + 1][v] * sphere[1] + m[4 * i + 2][v] * sphere[2] + m[4 * i + 3][v];
        locate(views, lanes, view, m, centre, radius, &work->sight);
        look(views, lanes, view, m, centre, radius, own, &work->sight);
    }
}

/* Draws a rigid segment into the views from first to last (exclusive). */
static void draw_segment(const sm_body *body, const sm_views *views, int32_t first, int32_t last, int32_t segment,
                         sm_work *work) {
    const sm_sight *sight = &work->sight;
    sm_see(body, views, segment, work);
    for (int32_t view = first; view < last; view++) {
        sm_picture *picture = work->pictures + view;
        if (picture->top >= picture->bottom || sight->where[view] == HIDDEN) continue;
        double a[12];
        eye e = sm_eye(views, view, sight, a);
        if (sight->where[view] == PLAIN) {
            if (sm_draw_closed(body, segment, &e, a, picture, work)) continue;
            if (sm_draw_contours(body, segment, &e, a, picture, work)) continue;
        }
        sm_draw_triangles(body, views->near, segment, a, picture);
    }
}

static void draw(const sm_body *body, const sm_views *views, const int32_t *segments, int32_t count, sm_work *work) {
    for (int32_t k = 0; k < count; k++) {
        if (!body->skinned[segments[k]]) {
            draw_segment(body, views, 0, views->views, segments[k], work);
            continue;
        }
        int32_t together = work->stride ? 1 : views->views; /* views that see the same pose */
        for (int32_t view = 0; view < views->views; view += together) {
            sm_work own;
            const sm_body *posed = sm_posed(body, view, segments[k], work, &own);
            draw_segment(posed, views, view, view + together, 0, &own);
        }
    }
}

static int64_t sum_planes(const uint64_t *rows, const uint64_t *plus, const uint64_t *minus, int32_t n) {
    int64_t sum = 0;
    for (int32_t k = 0; k < n; k++)
        sum += __builtin_popcountll(rows[k] & plus[k]) - __builtin_popcountll(rows[k] & minus[k]);
    return sum;
}

/* Spans of set bits in column k of words, by the sums at their ends. One that goes on in the next
 * column ends there, where that column's range holds the row. */
static int64_t sum_spans(const sm_picture *picture, int32_t k, const int32_t *sums) {
    static const int32_t none[2] = {0, 0};
    size_t height = (size_t)picture->height;
    const uint64_t *rows = picture->bits + height * (size_t)k, *before = k ? rows - height : rows;
    const int32_t *range = picture->ranges + 2 * k, *left = k ? range - 2 : none, *right = k + 1 < picture->words ? range + 2 : none;
    uint32_t left_rows = (uint32_t)(left[1] - left[0]), right_rows = (uint32_t)(right[1] - right[0]);
    int64_t sum = 0;
    for (int32_t y = range[0]; y < range[1]; y++) {
        uint64_t bits = rows[y], enters = (uint32_t)(y - left[0]) < left_rows ? before[y] >> 63 : 0;
        for (uint64_t changes = bits ^ (bits << 1 | enters); changes; changes &= changes - 1) {
            int i = __builtin_ctzll(changes);
            int64_t left_of = sums[height * (size_t)i + (size_t)y];
            sum += bits >> i & 1 ? -left_of : left_of;
        }
        if (bits >> 63 && !((uint32_t)(y - right[0]) < right_rows)) sum += sums[64 * height + (size_t)y];
    }
    return sum;
}

static int64_t sum(const sm_views *views, const sm_weights *weights, int32_t view, const sm_picture *picture) {
    size_t height = (size_t)picture->height, start = (size_t)views->word_starts[view];
    int64_t total = 0;
    for (int32_t k = 0; k < picture->words; k++) {
        int32_t y = picture->ranges[2 * k], n = picture->ranges[2 * k + 1] - y;
        size_t at = height * (size_t)k + (size_t)y;
        if (n <= 0) continue;
        total += weights->kind == SM_PLANES
                     ? sum_planes(picture->bits + at, weights->plus + start + at, weights->minus + start + at, n)
                     : sum_spans(picture, k, weights->sums + views->sum_starts[view] + 64 * height * (size_t)k);
    }
    return total;
}

static int32_t snap_checked(const sm_body *body, const sm_views *views, int32_t view, int32_t segment,
                            sm_work *work) {
    sm_work own;
    if (body->skinned[segment]) {
        body = sm_posed(body, view, segment, work, &own);
        segment = 0;
        work = &own;
    }
    double a[12], h[3];
    int32_t start = body->vertex_starts[segment], n = body->vertex_starts[segment + 1] - start, clean = 1;
    sm_see(body, views, segment, work);
    sm_eye(views, view, &work->sight, a);
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

const sm_path PATH(sm_path_) = {draw, sum, snap_checked, sm_outlines, sm_add_terms};
