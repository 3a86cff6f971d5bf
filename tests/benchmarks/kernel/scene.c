/* Bytes to joints, cameras and numbers. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t read_byte(reader *r) { return r->at < r->size ? r->data[r->at++] : 0; }

uint32_t read_below(reader *r, uint32_t n) { return read_byte(r) % n; }

double read_number(reader *r, double largest) {
    int32_t high = (int32_t)(int8_t)read_byte(r);
    return largest * (high + (double)read_byte(r) / 256.0) / 128.0;
}

double read_wild(reader *r, double largest) {
    static const double wild[] = {0.0,   -0.0,   NAN,    -NAN,   INFINITY, -INFINITY, 1e300, -1e300,
                                  1e160, 1e-300, 1e-160, 1e17,   -1e17,    1e9,       -1e9,  4e5,
                                  1e38,  -1e38,  1e39,   5e-324, 3.14159265358979, 1e5, 16000.0, 0.01};
    uint32_t kind = read_byte(r);
    return kind < sizeof wild / sizeof *wild ? wild[kind] : read_number(r, largest);
}

void *new_room(scene *s, size_t count, size_t size) {
    void *array = malloc(count ? count * size : 1);
    if (!array || s->count == MOST_ARRAYS) abort();
    s->sizes[s->count] = size == 4 ? (int32_t)count : 0;
    return s->arrays[s->count++] = array;
}

void *new_array(scene *s, size_t count, size_t size) { return memset(new_room(s, count, size), 0, count * size); }

void forget(scene *s) {
    while (s->count) free(s->arrays[--s->count]);
}

static void read_axis(reader *r, double *axis) {
    double length = 0.0;
    for (int i = 0; i < 3; i++) axis[i] = read_number(r, 1.0), length += axis[i] * axis[i];
    for (int i = 0; i < 3; i++) axis[i] = length > 0.0 ? axis[i] / sqrt(length) : i == 0;
}

/* Joints and degrees of freedom; the surfaces are filled in later. */
void read_body(reader *r, scene *s) {
    enum { MOST_JOINTS = 5, MOST_DOFS = 5 * 6 };
    int32_t joints = 1 + (int32_t)read_below(r, MOST_JOINTS), dofs = 0, odd = (int32_t)read_below(r, 2);
    int32_t kinds[MOST_DOFS], *parents = new_array(s, (size_t)joints, 4), *starts = new_array(s, (size_t)joints + 1, 4);
    double *offsets = new_array(s, 3 * (size_t)joints, 8);
    for (int32_t j = 0; j < joints; j++) {
        parents[j] = (int32_t)read_below(r, (uint32_t)j + 1) - 1;
        if (j && parents[j] < 0 && read_below(r, 4)) parents[j] = j - 1;
        for (int i = 0; i < 3 && odd; i++) offsets[3 * j + i] = read_number(r, 0.5);
        for (uint32_t n = read_below(r, 4); n; n--) {
            int32_t kind = (int32_t)read_below(r, 3);
            kinds[dofs++] = kind;
            if (kind == SM_SWING) kinds[dofs++] = kind;
        }
        starts[j + 1] = dofs;
    }
    int32_t *own = new_array(s, (size_t)dofs, 4);
    double *axes = new_array(s, 3 * (size_t)dofs, 8);
    for (int32_t d = 0; d < dofs; d++) {
        own[d] = kinds[d];
        read_axis(r, axes + 3 * d);
    }
    s->body.joints = joints;
    s->body.dofs = dofs;
    s->body.parents = parents;
    s->body.offsets = offsets;
    s->body.dof_starts = starts;
    s->body.dof_kinds = own;
    s->body.dof_axes = axes;
}

/* Which segments follow several joints, and how; to be called when the surfaces are there. */
void read_skin(reader *r, scene *s) {
    sm_body *body = &s->body;
    size_t joints = (size_t)body->joints, corners = 0;
    uint8_t *skinned = new_array(s, (size_t)body->segments, 1);
    double *rests = new_array(s, 3 * joints, 8);
    for (int32_t k = 0; k < body->segments; k++) {
        skinned[k] = read_below(r, 3) == 2;
        if (skinned[k]) corners = 4 * (size_t)body->vertices;
    }
    for (size_t j = 0; j < joints; j++)
        for (size_t i = 0; i < 3; i++)
            rests[3 * j + i] = body->offsets[3 * j + i] + (body->parents[j] < 0 ? 0.0 : rests[3 * (size_t)body->parents[j] + i]);
    int32_t *followed = new_array(s, corners, 4), most = 1 + (int32_t)read_below(r, 4);
    float *weights = new_array(s, corners, 4);
    for (size_t v = 0; v < corners; v += 4) {
        float sum = 0.0f;
        for (int32_t k = 0; k < most; k++) {
            followed[v + (size_t)k] = (int32_t)read_below(r, (uint32_t)joints);
            sum += weights[v + (size_t)k] = (float)(1 + read_byte(r));
        }
        for (int32_t k = 0; k < most; k++) weights[v + (size_t)k] /= sum;
    }
    body->skinned = skinned, body->skin_joints = followed, body->skin_weights = weights, body->rests = rests;
}

static void read_rotation(reader *r, double m[3][3]) {
    double q[4], n = 0.0;
    int32_t turns = (int32_t)read_below(r, 2);
    for (int i = 0; i < 4; i++) q[i] = turns * ((int32_t)(int8_t)read_byte(r) / 32), n += q[i] * q[i];
    if (n == 0.0) q[0] = n = 1.0;
    double w = q[0], x = q[1], y = q[2], z = q[3], k = 2.0 / n;
    double rows[9] = {1 - k * (y * y + z * z), k * (x * y - z * w),     k * (x * z + y * w),
                      k * (x * y + z * w),     1 - k * (x * x + z * z), k * (y * z - x * w),
                      k * (x * z - y * w),     k * (y * z + x * w),     1 - k * (x * x + y * y)};
    memcpy(m, rows, sizeof rows);
}

static void read_size(reader *r, int32_t *size) {
    uint32_t shape = read_byte(r);
    size[0] = 1 + (int32_t)read_below(r, shape < 64 ? 200 : 100);
    size[1] = 1 + (int32_t)read_below(r, shape < 128 ? 90 : 30);
    if (shape == 0) size[0] = 1 + (int32_t)read_below(r, 3), size[1] = 8180 + (int32_t)read_below(r, 20);
    if (shape == 1) size[0] = 32767, size[1] = 1;
}

/* The clipping planes and optics are those of core/rendering/model.py. */
static void look_from(reader *r, scene *s, int32_t view, size_t lanes, const int32_t *size, double *projections,
                      double *planes, double *optics) {
    static const double focals[] = {8.0, 40.0, 200.0, 1500.0, 3e4, -60.0, 0.5, 1e6, 64.0, 128.0};
    static const double distances[] = {2.0, 1.0, 0.0, 0.3, 8.0, 400.0, -2.0, 1e5, 1e17};
    double rotation[3][3], t[3], p[3][4], f = focals[read_below(r, 10)], odd = read_below(r, 2);
    read_rotation(r, rotation);
    double g = f * (1.0 + odd * read_number(r, 0.2)), x = odd * read_number(r, 30), y = odd * read_number(r, 30);
    t[0] = odd * read_number(r, 0.5), t[1] = odd * read_number(r, 0.5);
    t[2] = distances[read_below(r, 9)] + odd * read_number(r, 0.1);
    double k[3][3] = {{f, 0, size[0] / 2 + x}, {0, g, size[1] / 2 + y}, {0, 0, 1}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            p[i][j] = 0.0;
            for (int n = 0; n < 3; n++) p[i][j] += k[i][n] * (j < 3 ? rotation[n][j] : t[n]);
            projections[((size_t)i * 4 + (size_t)j) * lanes + (size_t)view] = p[i][j];
        }
    const double sides[8][2] = {{SM_GUARD_PX, 1}, {SM_GUARD_PX, -1}, {SM_GUARD_PX, 1}, {SM_GUARD_PX, -1},
                                {0, 1},           {size[0], -1},     {0, 1},           {size[1], -1}};
    for (int n = 0; n < 9; n++) {
        double plane[4], length = 0.0;
        for (int j = 0; j < 4; j++)
            plane[j] = n ? sides[n - 1][0] * p[2][j] + sides[n - 1][1] * p[(n - 1) / 2 % 2][j]
                         : p[2][j] - (j == 3 ? s->views.near : 0.0);
        for (int j = 0; j < 3; j++) length += plane[j] * plane[j];
        for (int j = 0; j < 4; j++) planes[(4 * (size_t)n + (size_t)j) * lanes + (size_t)view] = plane[j] / sqrt(length);
    }
    for (size_t i = 0; i < 3; i++)
        optics[i * lanes + (size_t)view] = -(rotation[0][i] * t[0] + rotation[1][i] * t[1] + rotation[2][i] * t[2]);
    optics[3 * lanes + (size_t)view] = f * g;
    optics[4 * lanes + (size_t)view] = fmax(fabs(f), fabs(g));
}

void read_views(reader *r, scene *s) {
    size_t views = 1 + read_below(r, read_below(r, 8) ? 3 : 10), lanes = (views + SM_LANES - 1) / SM_LANES * SM_LANES;
    int32_t *sizes = new_array(s, 2 * views, 4);
    double *projections = new_array(s, 12 * lanes, 8), *planes = new_array(s, 36 * lanes, 8);
    double *optics = new_array(s, 5 * lanes, 8);
    int64_t *starts[3];
    for (int i = 0; i < 3; i++) starts[i] = new_array(s, views + 1, 8);
    s->views = (sm_views){(int32_t)views, 1, 0.01, sizes, projections, planes, optics, starts[0], starts[1], starts[2]};
    for (size_t v = 0; v < views; v++) {
        read_size(r, sizes + 2 * v);
        int64_t width = sizes[2 * v], height = sizes[2 * v + 1];
        starts[0][v + 1] = starts[0][v] + (width + 63) / 64 * height;
        starts[1][v + 1] = starts[1][v] + width * height;
        starts[2][v + 1] = starts[2][v] + (width + 1) * height;
        look_from(r, s, (int32_t)v, lanes, sizes + 2 * v, projections, planes, optics);
    }
    for (size_t v = views; v < lanes; v++) {
        for (size_t i = 0; i < 12; i++) projections[i * lanes + v] = projections[i * lanes];
        for (size_t i = 0; i < 36; i++) planes[i * lanes + v] = planes[i * lanes];
        for (size_t i = 0; i < 5; i++) optics[i * lanes + v] = optics[i * lanes];
    }
}

/* Overwrites numbers of 32 bits, indices and planes alike; sm_check must find what would be dangerous.
 * Sizes, and vertices inside their spheres, are what a caller promises. */
void spoil(reader *r, scene *s) {
    for (uint32_t n = 1 + read_below(r, 4); n; n--) {
        uint32_t chosen = read_below(r, (uint32_t)s->count), kind = read_below(r, 8);
        const void *array = s->arrays[chosen], *promised[] = {s->views.sizes, s->body.x, s->body.y, s->body.z};
        int is_promised = 0;
        for (int i = 0; i < 4; i++) is_promised |= array == promised[i];
        if (is_promised || !s->sizes[chosen]) continue;
        uint32_t place = (read_byte(r) << 8 | read_byte(r)) % (uint32_t)s->sizes[chosen];
        static const uint32_t odd[] = {0xffffffff, 0x7fffffff, 0x80000000, 0x7fc00000, 0x7f800000};
        uint32_t *number = (uint32_t *)s->arrays[chosen] + place;
        *number = kind < 5 ? odd[kind] : *number + (uint32_t)((int8_t)read_byte(r) / (kind == 5 ? 1 : 50));
    }
}
