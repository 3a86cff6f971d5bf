/* Segments whose vertices follow several joints (linear blend skinning): posed anew for every candidate
 * as a body of one rigid segment that stands in the world. Positions are rounded to float, so that all
 * backends draw the same surface. */
#include "path.h"

#include <math.h>

enum { INFLUENCES = 4 };

/* World metres of the vertices from start on. */
static void blend(const sm_body *body, const double *transforms, int32_t start, int32_t n, const double *rest,
                  float *const *out) {
    for (int32_t i = 0; i < n; i++) {
        size_t v = (size_t)(start + i);
        double p[3] = {body->x[v], body->y[v], body->z[v]}, sum[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < INFLUENCES; k++) {
            int32_t joint = body->skin_joints[INFLUENCES * v + (size_t)k];
            const double *m = transforms + 12 * (size_t)joint, *own = body->rests + 3 * (size_t)joint;
            double weight = body->skin_weights[INFLUENCES * v + (size_t)k];
            double x = p[0] + (rest[0] - own[0]), y = p[1] + (rest[1] - own[1]), z = p[2] + (rest[2] - own[2]);
            for (int a = 0; a < 3; a++) sum[a] += weight * (m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3]);
        }
        for (int a = 0; a < 3; a++) out[a][i] = (float)sum[a];
    }
}

/* A sphere round the vertices, not the smallest. */
static void enclose(float *const *axes, int32_t n, double *sphere) {
    double low[3], high[3], radius = 0.0, total = 0.0;
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
        for (int32_t i = 0; i < n; i++) {
            low[a] = axes[a][i] < low[a] ? axes[a][i] : low[a];
            high[a] = axes[a][i] > high[a] ? axes[a][i] : high[a];
        }
        sphere[a] = (low[a] + high[a]) / 2.0;
    }
    for (int32_t i = 0; i < n; i++) {
        double x = axes[0][i] - sphere[0], y = axes[1][i] - sphere[1], z = axes[2][i] - sphere[2];
        double square = x * x + y * y + z * z;
        radius = square > radius ? square : radius;
        total += square;
    }
    sphere[3] = sqrt(radius) + 0.0 * total; /* not a number where one vertex is nowhere */
}

/* Planes and margins of n faces, as in sm_body. */
static void find_planes(const int32_t *corners, float *const *axes, int32_t n, float *planes) {
    const double round_up = 1.0 + 1e-5;
    for (int32_t f = 0; f < n; f++) {
        const int32_t *c = corners + 3 * (size_t)f;
        double p[3], d[3], e[3], g[3];
        for (int a = 0; a < 3; a++) {
            p[a] = axes[a][c[0]];
            d[a] = axes[a][c[1]] - p[a];
            e[a] = axes[a][c[2]] - p[a];
            g[a] = e[a] - d[a];
        }
        double normal[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]};
        double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        double scale = length < 1e-18 ? 0.0 : 1.0 / length, offset = 0.0;
        double sides = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) +
                       sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
        for (int a = 0; a < 3; a++) {
            planes[(size_t)a * (size_t)n + (size_t)f] = (float)(normal[a] * scale);
            offset += normal[a] * scale * p[a];
        }
        float *own = planes + 3 * (size_t)n + f;
        own[0] = (float)offset;
        own[n] = scale > 0.0 ? (float)(sides * scale * round_up) : INFINITY;
        own[2 * (size_t)n] = scale > 0.0 ? (float)(scale * round_up) : INFINITY;
    }
}

const sm_body *sm_posed(const sm_body *body, int32_t view, int32_t segment, const sm_work *work, sm_work *own) {
    static const int32_t zeros[2] = {0, 0};
    static const uint8_t rigid[1] = {0};
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    sm_skin *skin = work->skin;
    int32_t start = body->vertex_starts[segment], first = body->cluster_starts[segment];
    int32_t n = body->vertex_starts[segment + 1] - start, clusters = body->cluster_starts[segment + 1] - first;
    const double *rest = body->rests + 3 * (size_t)body->segment_joints[segment];
    const int32_t *corners = body->corners + 3 * SM_CLUSTER * (size_t)first;
    blend(body, work->transforms + work->stride * (size_t)view, start, n, rest, skin->axes);
    enclose(skin->axes, n, skin->sphere);
    find_planes(corners, skin->axes, SM_CLUSTER * clusters, skin->face_planes);
    memset(skin->cluster_planes, 0, sizeof(float) * 8 * (size_t)clusters);
    for (int32_t k = 0; k < clusters; k++) skin->cluster_planes[4 * (size_t)clusters + (size_t)k] = INFINITY;
    skin->vertex_starts[1] = n;
    skin->cluster_starts[1] = clusters;
    skin->body = *body;
    skin->body.joints = skin->body.segments = 1;
    skin->body.vertices = n;
    skin->body.clusters = clusters;
    skin->body.edge_clusters = 0;
    skin->body.skinned = rigid;
    skin->body.segment_joints = zeros;
    skin->body.edge_starts = zeros;
    skin->body.spheres = skin->sphere;
    skin->body.vertex_starts = skin->vertex_starts;
    skin->body.cluster_starts = skin->cluster_starts;
    skin->body.run_starts = body->run_starts + first;
    skin->body.x = skin->axes[0];
    skin->body.y = skin->axes[1];
    skin->body.z = skin->axes[2];
    skin->body.corners = corners;
    skin->body.face_planes = skin->face_planes;
    skin->body.cluster_planes = skin->cluster_planes;
    *own = *work;
    memcpy(skin->identity, identity, sizeof identity);
    own->transforms = skin->identity;
    own->stride = 0;
    return &skin->body;
}
