/* Triangles to what the kernel wants to know of them: written for this test from the comments of
 * kernel.h, so that the package's own preparation is checked as well. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An edge of one or two faces; `none` faces stand for no face. */
typedef struct {
    int32_t p, q, faces[2], next;
} record;

/* One segment on its way into the body. */
typedef struct {
    const mesh *m;
    int32_t clusters, none, records, is_closed;
    int32_t (*corners)[3];
    double (*planes)[6], (*middles)[3];
    record edges[MOST_RECORDS];
} piece;

/* Unit normal, its place, and the margins' factors. */
static void plane_of(const mesh *m, const int32_t *c, double *plane, double *middle) {
    double a[3], b[3], n[3], first = 0.0, second = 0.0, third = 0.0, length = 0.0;
    for (int i = 0; i < 3; i++) {
        a[i] = (double)m->at[c[1]][i] - m->at[c[0]][i];
        b[i] = (double)m->at[c[2]][i] - m->at[c[0]][i];
        middle[i] = ((double)m->at[c[0]][i] + m->at[c[1]][i] + m->at[c[2]][i]) / 3.0;
        first += a[i] * a[i], second += b[i] * b[i], third += (a[i] - b[i]) * (a[i] - b[i]);
    }
    for (int i = 0; i < 3; i++) {
        n[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
        length += n[i] * n[i];
    }
    length = sqrt(length);
    int flat = length < 1e-18;
    plane[3] = 0.0;
    for (int i = 0; i < 3; i++) {
        plane[i] = flat ? 0.0 : n[i] / length;
        plane[3] += plane[i] * m->at[c[0]][i];
    }
    plane[4] = flat ? INFINITY : (sqrt(first) + sqrt(second) + sqrt(third)) / length * (1.0 + 1e-5);
    plane[5] = flat ? INFINITY : 1.0 / length * (1.0 + 1e-5);
}

/* The eight numbers by which n faces are judged at once. */
static void joint_plane(const piece *s, const int32_t *faces, int32_t n, float *out, size_t stride) {
    double mean[4] = {0}, centre[3] = {0}, apart = 0.0, along = 0.0, margins[2] = {0};
    for (int32_t k = 0; k < n; k++)
        for (int i = 0; i < 3; i++) mean[i] += s->planes[faces[k]][i] / n, centre[i] += s->middles[faces[k]][i] / n;
    for (int32_t k = 0; k < n; k++) {
        const double *plane = s->planes[faces[k]];
        double away = 0.0, off = 0.0;
        for (int i = 0; i < 3; i++) {
            away += (plane[i] - mean[i]) * (plane[i] - mean[i]);
            off += plane[i] * (s->middles[faces[k]][i] - centre[i]);
        }
        apart = fmax(apart, sqrt(away));
        along = fmax(along, fabs(off));
        margins[0] = fmax(margins[0], plane[4]);
        margins[1] = fmax(margins[1], plane[5]);
    }
    for (int i = 0; i < 3; i++) mean[3] += mean[i] * centre[i];
    for (int i = 0; i < 4; i++) out[(size_t)i * stride] = (float)mean[i];
    out[4 * stride] = (float)(apart * (1.0 + 1e-5));
    out[5 * stride] = (float)(along * (1.0 + 1e-5));
    out[6 * stride] = (float)margins[0];
    out[7 * stride] = (float)margins[1];
}

/* Puts the edge of one face into a record that lacks this side of it. */
static void add_edge(piece *s, int32_t *heads, int32_t face, int32_t from, int32_t to) {
    int32_t p = from < to ? from : to, q = from < to ? to : from, side = from > to, *head = heads + (31 * p + q) % 1024;
    int32_t k = *head, found = -1;
    for (; k >= 0; k = s->edges[k].next)
        if (s->edges[k].p == p && s->edges[k].q == q && s->edges[k].faces[side] == s->none) found = k;
    if (found < 0) {
        found = s->records++;
        s->edges[found] = (record){p, q, {s->none, s->none}, *head};
        *head = found;
    }
    s->edges[found].faces[side] = face;
}

static void find_records(piece *s) {
    static int32_t heads[1024];
    memset(heads, 0xff, sizeof heads);
    for (int32_t f = 0; f < s->m->faces; f++) {
        const int32_t *c = s->m->corners[f];
        if (c[0] == c[1] || c[1] == c[2] || c[0] == c[2]) continue;
        for (int i = 0; i < 3; i++) add_edge(s, heads, f, c[i], c[(i + 1) % 3]);
    }
    s->is_closed = s->records > 0;
    for (int32_t k = 0; k < s->records; k++) {
        const int32_t *faces = s->edges[k].faces;
        if (faces[0] == s->none || faces[1] == s->none) s->is_closed = 0;
    }
}

/* The cluster that owns a record. */
static int32_t owner(const record *e) {
    return (e->faces[0] < e->faces[1] ? e->faces[0] : e->faces[1]) / SM_CLUSTER;
}

static int by_owner(const void *a, const void *b) { return owner(a) - owner(b); }

static void start_piece(piece *s, const mesh *m) {
    s->m = m;
    s->clusters = (m->faces + SM_CLUSTER - 1) / SM_CLUSTER;
    s->none = SM_CLUSTER * s->clusters;
    s->records = 0;
    s->corners = malloc((size_t)s->none * sizeof *s->corners + 1);
    s->planes = malloc((size_t)s->none * sizeof *s->planes + 1);
    s->middles = malloc((size_t)s->none * sizeof *s->middles + 1);
    for (int32_t f = 0; f < s->none; f++) {
        memcpy(s->corners[f], m->corners[f < m->faces ? f : m->faces - 1], sizeof *s->corners);
        plane_of(m, s->corners[f], s->planes[f], s->middles[f]);
    }
    find_records(s);
    qsort(s->edges, (size_t)s->records, sizeof *s->edges, by_owner);
}

static void end_piece(piece *s) {
    free(s->corners);
    free(s->planes);
    free(s->middles);
}

/* Arrays of the body under construction. */
typedef struct {
    int32_t *vertex_starts, *cluster_starts, *run_starts, *edge_starts, *corners, *record_vertices, *record_faces;
    int32_t *edge_corners;
    uint32_t *edge_ends;
    float *x[3], *face_planes, *cluster_planes, *edge_cones, *edge_sides;
    double *spheres;
} surfaces;

static void put_vertices(const mesh *m, int32_t segment, const surfaces *to) {
    double *sphere = to->spheres + 4 * segment, low[3], high[3];
    for (int i = 0; i < 3; i++) low[i] = INFINITY, high[i] = -INFINITY;
    for (int32_t v = 0; v < m->vertices; v++)
        for (int i = 0; i < 3; i++) {
            to->x[i][to->vertex_starts[segment] + v] = m->at[v][i];
            low[i] = fmin(low[i], m->at[v][i]), high[i] = fmax(high[i], m->at[v][i]);
        }
    for (int i = 0; i < 3 && m->vertices; i++) sphere[i] = (low[i] + high[i]) / 2.0;
    for (int32_t v = 0; v < m->vertices; v++) {
        double dx = m->at[v][0] - sphere[0], dy = m->at[v][1] - sphere[1], dz = m->at[v][2] - sphere[2];
        sphere[3] = fmax(sphere[3], sqrt(dx * dx + dy * dy + dz * dz));
    }
}

/* Lengths of the runs of records, as starts of what comes behind them. */
static void put_run_starts(const piece *s, int32_t first, int32_t *starts) {
    int32_t *own = starts + first;
    for (int32_t c = 0, k = 0; c < s->clusters; c++) {
        int32_t n = 0;
        while (k < s->records && owner(s->edges + k) == c) k++, n++;
        own[c + 1] = own[c] + (n + SM_RUN - 1) / SM_RUN * SM_RUN;
    }
}

/* Clusters of faces and the records they own; there are `clusters` in the whole body. */
static void put_clusters(const piece *s, int32_t first, size_t clusters, const surfaces *to) {
    static int32_t ring[SM_CLUSTER + 2 * MOST_RECORDS];
    size_t faces = SM_CLUSTER * clusters, start = SM_CLUSTER * (size_t)first;
    memcpy(to->corners + 3 * start, s->corners, sizeof *s->corners * (size_t)s->none);
    for (int32_t f = 0; f < s->none; f++)
        for (size_t i = 0; i < 6; i++) to->face_planes[i * faces + start + (size_t)f] = (float)s->planes[f][i];
    for (int32_t c = 0, k = 0; c < s->clusters; c++) {
        int32_t n = 0, is_open = 0, at = to->run_starts[first + c];
        for (; n < SM_CLUSTER; n++) ring[n] = SM_CLUSTER * c + n;
        for (; k < s->records && owner(s->edges + k) == c; k++, at++) {
            to->record_vertices[2 * at] = s->edges[k].p, to->record_vertices[2 * at + 1] = s->edges[k].q;
            for (int i = 0; i < 2; i++) {
                int32_t face = to->record_faces[2 * at + i] = s->edges[k].faces[i];
                if (face == s->none) is_open = 1;
                else ring[n++] = face;
            }
        }
        for (; at < to->run_starts[first + c + 1]; at++) to->record_faces[2 * at] = to->record_faces[2 * at + 1] = s->none + 1;
        joint_plane(s, ring, n, to->cluster_planes + first + c, clusters);
        if (is_open) to->cluster_planes[4 * clusters + (size_t)(first + c)] = INFINITY;
    }
}

static int32_t edge_clusters(const piece *s) { return s->is_closed ? (s->records + SM_CLUSTER - 1) / SM_CLUSTER : 0; }

/* Sixteen edges of a closed surface; what is missing has two faces that show their fronts. */
static void put_edges(const piece *s, int32_t cluster, size_t at, size_t clusters, const surfaces *to) {
    int32_t ring[2 * SM_CLUSTER], n = 0, first = SM_CLUSTER * cluster;
    for (int32_t i = 0; i < SM_CLUSTER; i++) {
        float *side = to->edge_sides + 128 * at + i;
        int32_t *corners = to->edge_corners + 4 * (SM_CLUSTER * at + (size_t)i);
        const record *e = first + i < s->records ? s->edges + first + i : 0;
        side[3 * SM_CLUSTER] = side[7 * SM_CLUSTER] = -1.0f;
        for (int k = 0; k < 2 && e; k++) {
            const int32_t *c = s->corners[e->faces[k]];
            for (int j = 0; j < 4; j++) side[(4 * k + j) * SM_CLUSTER] = (float)s->planes[e->faces[k]][j];
            corners[k] = k ? e->q : e->p;
            corners[2 + k] = c[0] + c[1] + c[2] - e->p - e->q;
            ring[n++] = e->faces[k];
        }
        to->edge_ends[SM_CLUSTER * at + (size_t)i] = e ? (uint32_t)e->p | (uint32_t)e->q << 16 : 0;
    }
    joint_plane(s, ring, n, to->edge_cones + at, clusters);
}

static void put_piece(const piece *s, int32_t segment, const sm_body *body, const surfaces *to) {
    put_vertices(s->m, segment, to);
    put_clusters(s, to->cluster_starts[segment], (size_t)body->clusters, to);
    for (int32_t k = 0; k < edge_clusters(s); k++)
        put_edges(s, k, (size_t)(to->edge_starts[segment] + k), (size_t)body->edge_clusters, to);
}

/* The arrays that hold as many numbers as the starts say. */
static void make_arrays(scene *s, surfaces *to) {
    const sm_body *body = &s->body;
    size_t clusters = (size_t)body->clusters, records = 2 * (size_t)body->records, edges = (size_t)body->edge_clusters;
    for (int i = 0; i < 3; i++) to->x[i] = new_array(s, (size_t)body->vertices + 8, 4);
    to->spheres = new_array(s, 4 * (size_t)body->segments, 8);
    to->corners = new_array(s, 3 * SM_CLUSTER * clusters, 4);
    to->face_planes = new_array(s, 6 * SM_CLUSTER * clusters, 4);
    to->cluster_planes = new_array(s, 8 * clusters, 4);
    to->record_vertices = new_array(s, records, 4);
    to->record_faces = new_array(s, records, 4);
    to->edge_cones = new_array(s, 8 * edges + 16, 4);
    to->edge_sides = new_array(s, 128 * edges, 4);
    to->edge_ends = new_array(s, SM_CLUSTER * edges, 4);
    to->edge_corners = new_array(s, 4 * SM_CLUSTER * edges, 4);
}

static void point_at(sm_body *body, const surfaces *from) {
    body->spheres = from->spheres;
    body->vertex_starts = from->vertex_starts, body->cluster_starts = from->cluster_starts;
    body->run_starts = from->run_starts, body->edge_starts = from->edge_starts;
    body->x = from->x[0], body->y = from->x[1], body->z = from->x[2];
    body->corners = from->corners, body->face_planes = from->face_planes, body->cluster_planes = from->cluster_planes;
    body->record_vertices = from->record_vertices, body->record_faces = from->record_faces;
    body->edge_cones = from->edge_cones, body->edge_sides = from->edge_sides;
    body->edge_ends = from->edge_ends, body->edge_corners = from->edge_corners;
}

void fill_surfaces(scene *s, const mesh *meshes, int32_t segments) {
    static piece pieces[MOST_SEGMENTS];
    surfaces to;
    size_t n = (size_t)segments + 1;
    int32_t **starts[] = {&to.vertex_starts, &to.cluster_starts, &to.edge_starts};
    for (int i = 0; i < 3; i++) *starts[i] = new_array(s, n, 4);
    for (int32_t k = 0; k < segments; k++) {
        start_piece(pieces + k, meshes + k);
        to.vertex_starts[k + 1] = to.vertex_starts[k] + meshes[k].vertices;
        to.cluster_starts[k + 1] = to.cluster_starts[k] + pieces[k].clusters;
        to.edge_starts[k + 1] = to.edge_starts[k] + edge_clusters(pieces + k);
    }
    to.run_starts = new_array(s, (size_t)to.cluster_starts[segments] + 1, 4);
    for (int32_t k = 0; k < segments; k++) put_run_starts(pieces + k, to.cluster_starts[k], to.run_starts);
    s->body.segments = segments;
    s->body.vertices = to.vertex_starts[segments];
    s->body.clusters = to.cluster_starts[segments];
    s->body.records = to.run_starts[to.cluster_starts[segments]];
    s->body.edge_clusters = to.edge_starts[segments];
    make_arrays(s, &to);
    point_at(&s->body, &to);
    for (int32_t k = 0; k < segments; k++) {
        put_piece(pieces + k, k, &s->body, &to);
        end_piece(pieces + k);
    }
}
