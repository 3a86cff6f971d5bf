/* The entry points: sizes checked, scratch cut, code path chosen. */
#include "internal.h"

#include <string.h>

#ifndef SM_FINGERPRINT
#define SM_FINGERPRINT ""
#endif

int32_t sm_abi(void) { return SM_ABI; }

const char *sm_sources(void) { return SM_FINGERPRINT; }

static const sm_path *path_of(const sm_views *views) {
#if defined(__x86_64__)
    if (views->processor == 4) return &sm_path_v4;
    if (views->processor == 3) return &sm_path_v3;
#endif
    return views->processor == 1 ? &sm_path_base : 0;
}

/* Largest count of a segment in a table of starts, or -1 where the table is not increasing. */
static int64_t largest(const int32_t *starts, int32_t n) {
    int64_t most = 0;
    for (int32_t s = 0; s < n; s++) {
        int64_t count = (int64_t)starts[s + 1] - starts[s];
        if (count < 0) return -1;
        if (count > most) most = count;
    }
    return most;
}

static size_t take(size_t *at, int64_t count, size_t size) {
    size_t start = *at;
    *at = (start + (size_t)count * size + 63) & ~(size_t)63;
    return start;
}

size_t sm_cut(const sm_body *body, const sm_views *views, void *base, sm_work *work) {
    int64_t height = 0, words = 0, vertices = largest(body->vertex_starts, body->segments);
    int64_t faces = largest(body->face_starts, body->segments), records = largest(body->record_starts, body->segments);
    for (int32_t v = 0; v < views->views; v++) {
        int64_t count = views->word_starts[v + 1] - views->word_starts[v];
        if (views->sizes[2 * v + 1] > height) height = views->sizes[2 * v + 1];
        if (count > words) words = count;
    }
    char *bytes = (char *)(((uintptr_t)base + 63) & ~(uintptr_t)63);
    size_t at = 0;
    work->transforms = (double *)(bytes + take(&at, 12 * (int64_t)body->joints, sizeof(double)));
    work->needed = (uint8_t *)(bytes + take(&at, body->joints, 1));
    work->qx = (int32_t *)(bytes + take(&at, vertices, sizeof(int32_t)));
    work->qy = (int32_t *)(bytes + take(&at, vertices, sizeof(int32_t)));
    work->signs = (int8_t *)(bytes + take(&at, faces + 1, 1));
    work->found = (int32_t *)(bytes + take(&at, 2 * (records + 1), sizeof(int32_t)));
    work->counts = (uint8_t *)(bytes + take(&at, height, 1));
    work->slots = (int32_t *)(bytes + take(&at, height * SM_SLOTS, sizeof(int32_t)));
    work->rows = (uint64_t *)(bytes + take(&at, words, sizeof(uint64_t)));
    if (base) memset(work->counts, 0, (size_t)height);
    return at + 64;
}

size_t sm_scratch(const sm_body *body, const sm_views *views) {
    sm_work work;
    return sm_cut(body, views, 0, &work);
}

static int32_t check_body(const sm_body *body) {
    if (body->joints < 1 || body->dofs < 0 || body->segments < 1) return SM_SIZE;
    if (body->dof_starts[0] != 0 || body->dof_starts[body->joints] != body->dofs) return SM_SIZE;
    if (largest(body->dof_starts, body->joints) < 0 || largest(body->vertex_starts, body->segments) < 0 ||
        largest(body->face_starts, body->segments) < 0 || largest(body->record_starts, body->segments) < 0)
        return SM_SIZE;
    int32_t n = body->segments;
    if (body->vertex_starts[0] || body->face_starts[0] || body->record_starts[0]) return SM_SIZE;
    if (body->vertex_starts[n] != body->vertices || body->face_starts[n] != body->faces ||
        body->record_starts[n] != body->records)
        return SM_SIZE;
    for (int32_t j = 0; j < body->joints; j++) {
        if (body->parents[j] < -1 || body->parents[j] >= j) return SM_INDEX;
        for (int32_t d = body->dof_starts[j]; d < body->dof_starts[j + 1]; d++) {
            if (body->dof_kinds[d] < SM_TRANSLATION || body->dof_kinds[d] > SM_SWING) return SM_INDEX;
            if (body->dof_kinds[d] == SM_SWING &&
                (++d >= body->dof_starts[j + 1] || body->dof_kinds[d] != SM_SWING))
                return SM_INDEX;
        }
    }
    return SM_OK;
}

static int in_range(const int32_t *values, int64_t n, int32_t end) {
    for (int64_t i = 0; i < n; i++)
        if (values[i] < 0 || values[i] >= end) return 0;
    return 1;
}

static int32_t check_mesh(const sm_body *body) {
    for (int32_t s = 0; s < body->segments; s++) {
        int32_t vertices = body->vertex_starts[s + 1] - body->vertex_starts[s];
        int32_t first = body->face_starts[s], faces = body->face_starts[s + 1] - first;
        int32_t record = body->record_starts[s], records = body->record_starts[s + 1] - record;
        if (!in_range(body->corners + 3 * (size_t)first, 3 * (int64_t)faces, vertices) ||
            !in_range(body->record_vertices + 2 * (size_t)record, 2 * (int64_t)records, vertices) ||
            !in_range(body->record_faces + 2 * (size_t)record, 2 * (int64_t)records, faces + 1))
            return SM_INDEX;
    }
    for (int64_t i = 0; i < 2 * (int64_t)body->records; i++)
        if (body->record_signs[i] < -1 || body->record_signs[i] > 1) return SM_INDEX;
    return in_range(body->segment_joints, body->segments, body->joints) ? SM_OK : SM_INDEX;
}

static int32_t check_views(const sm_views *views) {
    if (views->views < 1 || !(views->near > 0.0)) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++) {
        int64_t width = views->sizes[2 * v], height = views->sizes[2 * v + 1];
        if (width < 1 || height < 1 || width > 32767 || height > 32767) return SM_SIZE;
        if (views->word_starts[v + 1] - views->word_starts[v] != height * ((width + 63) >> 6) ||
            views->map_starts[v + 1] - views->map_starts[v] != height * width ||
            views->sum_starts[v + 1] - views->sum_starts[v] != height * (width + 1))
            return SM_SIZE;
    }
    return path_of(views) ? SM_OK : SM_PROCESSOR;
}

int32_t sm_check(const sm_body *body, const sm_views *views) {
    int32_t error = check_body(body);
    if (!error) error = check_mesh(body);
    return error ? error : check_views(views);
}

/* What every call on segments checks first. */
static int32_t begin(const sm_body *body, const sm_views *views, int64_t n, const int32_t *segments,
                     int32_t count, void *scratch, size_t bytes, sm_work *work) {
    if (n < 0 || count < 0) return SM_SIZE;
    if (!in_range(segments, count, body->segments)) return SM_INDEX;
    if (!path_of(views)) return SM_PROCESSOR;
    if (!scratch || bytes < sm_cut(body, views, scratch, work)) return SM_SCRATCH;
    sm_need(body, segments, count, work);
    return SM_OK;
}

int32_t sm_transforms(const sm_body *body, const double *poses, int64_t n, double *out) {
    if (n < 0) return SM_SIZE;
    for (int64_t i = 0; i < n; i++)
        sm_pose_transforms(body, poses + i * body->dofs, 0, out + 12 * i * body->joints);
    return SM_OK;
}

int32_t sm_energies(const sm_body *body, const sm_views *views, const sm_weights *weights, const double *poses,
                    int64_t n, int32_t per_view, const int32_t *segments, int32_t count, int64_t *out,
                    void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, n, segments, count, scratch, bytes, &work);
    if (error) return error;
    const sm_path *path = path_of(views);
    for (int64_t i = 0; i < n; i++) {
        for (int32_t v = 0; v < views->views; v++) {
            if (per_view || v == 0) {
                sm_pose_transforms(body, poses, work.needed, work.transforms);
                poses += body->dofs;
            }
            const int32_t *rows = weights->rows + 2 * v;
            *out = weights->constants[v];
            if (rows[0] < rows[1]) {
                path->draw(body, views, v, segments, count, rows[0], rows[1], &work);
                *out += path->sum(views, weights, v, &work);
            }
            out++;
        }
    }
    return SM_OK;
}

int32_t sm_silhouettes(const sm_body *body, const sm_views *views, const double *pose, int32_t per_view,
                       const int32_t *segments, int32_t count, uint64_t *out, void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, 1, segments, count, scratch, bytes, &work);
    if (error) return error;
    memset(out, 0, 8 * (size_t)views->word_starts[views->views]);
    for (int32_t v = 0; v < views->views; v++) {
        if (per_view || v == 0) sm_pose_transforms(body, pose + (size_t)v * body->dofs, work.needed, work.transforms);
        path_of(views)->draw(body, views, v, segments, count, 0, views->sizes[2 * v + 1], &work);
        size_t words = (size_t)((views->sizes[2 * v] + 63) >> 6), start = words * work.y0;
        memcpy(out + views->word_starts[v] + start, work.rows + start, 8 * words * (size_t)(work.y1 - work.y0));
    }
    return SM_OK;
}

/* Grows a box of snapped coordinates by the vertices of one segment. */
static void grow(const sm_work *work, int32_t n, int32_t *box) {
    for (int32_t i = 0; i < n; i++) {
        if (work->qx[i] < box[0]) box[0] = work->qx[i];
        if (work->qy[i] < box[1]) box[1] = work->qy[i];
        if (work->qx[i] > box[2]) box[2] = work->qx[i];
        if (work->qy[i] > box[3]) box[3] = work->qy[i];
    }
}

static void bound(const sm_body *body, const sm_views *views, int32_t view, const int32_t *segments,
                  int32_t count, int32_t *out, sm_work *work) {
    const int32_t guard = (int32_t)(256 * SM_GUARD_PX);
    int32_t box[4] = {INT32_MAX - 255, INT32_MAX - 255, INT32_MIN, INT32_MIN}, clean = 1, any = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t n = body->vertex_starts[segments[k] + 1] - body->vertex_starts[segments[k]];
        clean &= path_of(views)->snap(body, views, view, segments[k], work);
        any |= n > 0;
        grow(work, n, box);
    }
    if (!clean) box[0] = box[1] = -guard, box[2] = box[3] = guard;
    for (int i = 0; i < 4; i++) out[i] = any ? (box[i] + 255) >> 8 : 0;
}

int32_t sm_bounds(const sm_body *body, const sm_views *views, const double *poses, int64_t n, int32_t per_view,
                  const int32_t *segments, int32_t count, int32_t *out, void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, n, segments, count, scratch, bytes, &work);
    if (error) return error;
    for (int64_t i = 0; i < n; i++) {
        for (int32_t v = 0; v < views->views; v++, out += 4) {
            if (per_view || v == 0) {
                sm_pose_transforms(body, poses, work.needed, work.transforms);
                poses += body->dofs;
            }
            bound(body, views, v, segments, count, out, &work);
        }
    }
    return SM_OK;
}

int32_t sm_snapped(const sm_body *body, const sm_views *views, const double *pose, int32_t *out, void *scratch,
                   size_t bytes) {
    sm_work work;
    if (!path_of(views)) return SM_PROCESSOR;
    if (!scratch || bytes < sm_cut(body, views, scratch, &work)) return SM_SCRATCH;
    sm_pose_transforms(body, pose, 0, work.transforms);
    for (int32_t v = 0; v < views->views; v++) {
        for (int32_t s = 0; s < body->segments; s++) {
            path_of(views)->snap(body, views, v, s, &work);
            for (int32_t i = 0; i < body->vertex_starts[s + 1] - body->vertex_starts[s]; i++) {
                *out++ = work.qx[i];
                *out++ = work.qy[i];
            }
        }
    }
    return SM_OK;
}
