/* The entry points: sizes checked, scratch cut, code path chosen. */
#include "internal.h"

#include <string.h>

#ifndef SM_FINGERPRINT
#define SM_FINGERPRINT ""
#endif

int32_t sm_abi(void) { return SM_ABI; }

const char *sm_sources(void) { return SM_FINGERPRINT; }

static const sm_path *path_of(int32_t processor) {
#if defined(__x86_64__)
    if (processor == 4) return &sm_path_v4;
    if (processor == 3) return &sm_path_v3;
#endif
    return processor == 1 ? &sm_path_base : 0;
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

/* The records of segment s run from records_from(s) to records_from(s + 1). */
static int32_t records_from(const sm_body *body, int32_t s) { return body->run_starts[body->cluster_starts[s]]; }

static int64_t most_records(const sm_body *body) {
    int64_t most = 0;
    for (int32_t s = 0; s < body->segments; s++) {
        int64_t count = (int64_t)records_from(body, s + 1) - records_from(body, s);
        if (count > most) most = count;
    }
    return most;
}

/* Under AddressSanitizer, which knows the scratch as one block, a red zone lies behind every part. */
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
enum { RED_ZONE = 64 };
static void guard(char *start, size_t used, size_t end) {
    __asan_unpoison_memory_region(start, used);
    __asan_poison_memory_region(start + used, end - used);
}
#else
enum { RED_ZONE = 0 };
static void guard(char *start, size_t used, size_t end) { (void)start, (void)used, (void)end; }
#endif

static void *part(void *base, size_t *at, int64_t count, size_t size) {
    size_t start = *at, used = (size_t)count * size;
    char *place = (char *)(((uintptr_t)base + 63) & ~(uintptr_t)63) + start;
    *at = (start + used + RED_ZONE + 63) & ~(size_t)63;
    if (base) guard(place, used, *at - start);
    return place;
}

static void cut_sight(void *base, size_t *at, int64_t lanes, sm_sight *sight) {
    float **numbers[] = {&sight->at[0], &sight->at[1], &sight->at[2], &sight->reach, &sight->edge, &sight->step, &sight->slack};
    sight->a = part(base, at, 12 * lanes, sizeof(double));
    for (int i = 0; i < 7; i++) *numbers[i] = part(base, at, lanes, sizeof(float));
    sight->where = part(base, at, lanes, sizeof(int32_t));
    sight->front = part(base, at, lanes, sizeof(int32_t));
}

/* A part of words that are all 0. */
static uint64_t *blank(void *base, size_t *at, int64_t count) {
    uint64_t *words = part(base, at, count, sizeof(uint64_t));
    if (base) memset(words, 0, 8 * (size_t)count);
    return words;
}

/* Planes and counts are those of closed_plain.h. */
static void cut_edges(void *base, size_t *at, int64_t clusters, int64_t height, int64_t words, int plain, sm_edges *e) {
    int64_t most = SM_CLUSTER * (clusters + 2), rows = plain ? (height + 15) & ~7 : 0;
    e->rows = (size_t)rows;
    e->open = part(base, at, most, sizeof(int32_t));
    e->margins = part(base, at, clusters + 16, sizeof(float));
    e->sure = part(base, at, most, sizeof(uint32_t));
    e->row = part(base, at, most, sizeof(int32_t));
    e->end = part(base, at, most, sizeof(int32_t));
    e->at = part(base, at, most, sizeof(uint64_t));
    e->slope = part(base, at, most, sizeof(uint64_t));
    e->minus = part(base, at, most, sizeof(uint64_t));
    for (int i = 0; i < 3; i++) e->planes[i] = blank(base, at, rows * words);
    e->counts = blank(base, at, rows);
}

static void cut_skin(void *base, size_t *at, int64_t vertices, int64_t clusters, sm_work *work) {
    sm_skin *skin = part(base, at, 1, sizeof(sm_skin)), unused;
    work->skin = skin;
    if (!base) skin = &unused;
    for (int i = 0; i < 3; i++) skin->axes[i] = part(base, at, vertices + 8, sizeof(float));
    skin->face_planes = part(base, at, 6 * SM_CLUSTER * clusters, sizeof(float));
    skin->cluster_planes = part(base, at, 8 * clusters, sizeof(float));
    skin->vertex_starts[0] = skin->cluster_starts[0] = 0;
}

static void clear_picture(sm_picture *picture) { memset(picture->ranges, 0, 8 * (size_t)picture->words); }

size_t sm_cut(const sm_body *body, const sm_views *views, void *base, sm_work *work) {
    int64_t height = 0, most_words = 0, vertices = largest(body->vertex_starts, body->segments);
    int64_t clusters = largest(body->cluster_starts, body->segments), faces = SM_CLUSTER * clusters;
    int64_t records = most_records(body);
    for (int32_t v = 0; v < views->views; v++) {
        int64_t words = (views->sizes[2 * v] + 63) >> 6;
        if (views->sizes[2 * v + 1] > height) height = views->sizes[2 * v + 1];
        if (words > most_words) most_words = words;
    }
    size_t at = 0;
    work->transforms = part(base, &at, 12 * (int64_t)body->joints * views->views, sizeof(double));
    work->moved = part(base, &at, body->joints, 1);
    work->needed = part(base, &at, body->joints, 1);
    work->facing = part(base, &at, faces + 2, 1);
    int64_t edge_clusters = largest(body->edge_starts, body->segments);
    work->runs = part(base, &at, (clusters > edge_clusters ? clusters : edge_clusters) + 1, sizeof(int32_t));
    work->found = part(base, &at, records + 1, sizeof(int32_t));
    work->unknown = part(base, &at, (faces > records ? faces : records) + 1, sizeof(int32_t));
    work->places = part(base, &at, vertices, sizeof(int32_t));
    work->wanted = part(base, &at, vertices + 1, sizeof(int32_t));
    work->qx = part(base, &at, vertices, sizeof(int32_t));
    work->qy = part(base, &at, vertices, sizeof(int32_t));
    work->points = part(base, &at, vertices + 8, sizeof(int64_t));
    work->counts = part(base, &at, height, 1);
    work->slots = part(base, &at, height * SM_SLOTS, sizeof(int32_t));
    cut_edges(base, &at, edge_clusters, height, most_words, views->processor != 4, &work->edges);
    cut_skin(base, &at, vertices, clusters, work);
    cut_sight(base, &at, (int64_t)sm_lanes(views), &work->sight);
    work->pictures = part(base, &at, views->views, sizeof(sm_picture));
    int32_t *ranges = part(base, &at, 2 * most_words * views->views, sizeof(int32_t));
    uint64_t *bits = part(base, &at, views->word_starts[views->views] + 8, sizeof(uint64_t));
    if (!base) return at + 64;
    memset(work->counts, 0, (size_t)height);
    for (int32_t v = 0; v < views->views; v++, ranges += 2 * most_words) {
        int32_t width = views->sizes[2 * v], rows = views->sizes[2 * v + 1];
        work->pictures[v] = (sm_picture){width, rows, (width + 63) >> 6, 0, rows, ranges, bits + views->word_starts[v]};
        clear_picture(&work->pictures[v]);
    }
    return at + 64;
}

/* Takes one candidate's transforms from its pose or, where per_view, its V poses; returns the next.
 * `follows` says that the candidate before has just been taken. */
static const double *take_pose(const sm_body *body, const sm_views *views, const double *pose, int32_t per_view,
                               int follows, sm_work *work) {
    int32_t count = per_view ? views->views : 1;
    ptrdiff_t before = (ptrdiff_t)count * body->dofs;
    work->stride = per_view ? 12 * (size_t)body->joints : 0;
    for (int32_t v = 0; v < count; v++, pose += body->dofs)
        sm_pose_transforms(body, pose, follows ? pose - before : 0, work->moved, work->needed,
                           work->transforms + work->stride * (size_t)v);
    return pose;
}

size_t sm_scratch(const sm_body *body, const sm_views *views) {
    sm_work work;
    return sm_cut(body, views, 0, &work);
}

static int32_t check_body(const sm_body *body) {
    if (body->joints < 1 || body->dofs < 0 || body->segments < 1) return SM_SIZE;
    if (body->dof_starts[0] != 0 || body->dof_starts[body->joints] != body->dofs) return SM_SIZE;
    if (largest(body->dof_starts, body->joints) < 0 || largest(body->vertex_starts, body->segments) < 0 ||
        largest(body->cluster_starts, body->segments) < 0)
        return SM_SIZE;
    int32_t n = body->segments;
    if (body->vertex_starts[0] || body->cluster_starts[0] || body->vertex_starts[n] != body->vertices ||
        body->cluster_starts[n] != body->clusters || body->clusters < 0 || largest(body->run_starts, body->clusters) < 0 ||
        body->run_starts[0] || body->run_starts[body->clusters] != body->records || body->records % SM_RUN ||
        body->clusters > INT32_MAX / (6 * SM_CLUSTER))
        return SM_SIZE;
    if (largest(body->edge_starts, n) < 0 || body->edge_starts[0] || body->edge_starts[n] != body->edge_clusters ||
        body->edge_clusters > SM_MOST_EDGES / SM_CLUSTER)
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

static int32_t check_segment(const sm_body *body, int32_t s) {
    int32_t vertices = body->vertex_starts[s + 1] - body->vertex_starts[s];
    int32_t first = body->cluster_starts[s], clusters = body->cluster_starts[s + 1] - first;
    int32_t record = records_from(body, s), records = records_from(body, s + 1) - record;
    int64_t faces = SM_CLUSTER * (int64_t)clusters;
    size_t edge = SM_CLUSTER * (size_t)body->edge_starts[s], edges = SM_CLUSTER * (size_t)body->edge_starts[s + 1];
    for (size_t i = edge; i < edges; i++) {
        uint32_t p = body->edge_ends[i] & 0xffff, q = body->edge_ends[i] >> 16;
        if (p >= (uint32_t)vertices || q >= (uint32_t)vertices || ((p | q) & 0x8000)) return SM_INDEX;
    }
    if (!in_range(body->edge_corners + 4 * edge, 4 * (int64_t)(edges - edge), vertices)) return SM_INDEX;
    for (int32_t c = first; c < first + clusters; c++)
        if (body->run_starts[c] % SM_RUN) return SM_SIZE;
    if (!in_range(body->corners + 3 * SM_CLUSTER * (size_t)first, 3 * faces, vertices) ||
        !in_range(body->record_vertices + 2 * (size_t)record, 2 * (int64_t)records, vertices) ||
        !in_range(body->record_faces + 2 * (size_t)record, 2 * (int64_t)records, (int32_t)faces + 2))
        return SM_INDEX;
    return SM_OK;
}

static int32_t check_skin(const sm_body *body) {
    int any = 0;
    for (int32_t s = 0; s < body->segments; s++) any |= body->skinned[s];
    return !any || in_range(body->skin_joints, 4 * (int64_t)body->vertices, body->joints) ? SM_OK : SM_INDEX;
}

static int32_t check_mesh(const sm_body *body) {
    for (int32_t s = 0; s < body->segments; s++) {
        int32_t error = check_segment(body, s);
        if (error) return error;
    }
    return in_range(body->segment_joints, body->segments, body->joints) ? SM_OK : SM_INDEX;
}

static int32_t check_views(const sm_views *views) {
    if (views->views < 1 || !(views->near > 0.0)) return SM_SIZE;
    if (views->word_starts[0] || views->map_starts[0] || views->sum_starts[0]) return SM_SIZE;
    for (int32_t v = 0; v < views->views; v++) {
        int64_t width = views->sizes[2 * v], height = views->sizes[2 * v + 1];
        if (width < 1 || height < 1 || width > 32767 || height > 32767) return SM_SIZE;
        if (views->word_starts[v + 1] - views->word_starts[v] != height * ((width + 63) >> 6) ||
            views->map_starts[v + 1] - views->map_starts[v] != height * width ||
            views->sum_starts[v + 1] - views->sum_starts[v] != height * (width + 1))
            return SM_SIZE;
    }
    return path_of(views->processor) ? SM_OK : SM_PROCESSOR;
}

int32_t sm_check(const sm_body *body, const sm_views *views) {
    int32_t error = check_body(body);
    if (!error) error = check_mesh(body);
    if (!error) error = check_skin(body);
    return error ? error : check_views(views);
}

/* What every call on segments checks first. */
static int32_t begin(const sm_body *body, const sm_views *views, int64_t n, const int32_t *segments,
                     int32_t count, void *scratch, size_t bytes, sm_work *work) {
    if (n < 0 || count < 0) return SM_SIZE;
    if (!in_range(segments, count, body->segments)) return SM_INDEX;
    if (!path_of(views->processor)) return SM_PROCESSOR;
    if (!scratch || bytes < sm_scratch(body, views)) return SM_SCRATCH;
    sm_cut(body, views, scratch, work);
    sm_need(body, segments, count, work);
    return SM_OK;
}

int32_t sm_transforms(const sm_body *body, const double *poses, int64_t n, double *out) {
    if (n < 0) return SM_SIZE;
    for (int64_t i = 0; i < n; i++)
        sm_pose_transforms(body, poses + i * body->dofs, 0, 0, 0, out + 12 * i * body->joints);
    return SM_OK;
}

int32_t sm_energies(const sm_body *body, const sm_views *views, const sm_weights *weights, const double *poses,
                    int64_t n, int32_t per_view, const int32_t *segments, int32_t count, int64_t *out,
                    void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, n, segments, count, scratch, bytes, &work);
    if (error) return error;
    const sm_path *path = path_of(views->processor);
    for (int32_t v = 0; v < views->views; v++) {
        work.pictures[v].top = weights->rows[2 * v];
        work.pictures[v].bottom = weights->rows[2 * v + 1];
    }
    for (int64_t i = 0; i < n; i++) {
        poses = take_pose(body, views, poses, per_view, i > 0, &work);
        for (int32_t v = 0; v < views->views; v++) clear_picture(&work.pictures[v]);
        path->draw(body, views, segments, count, &work);
        for (int32_t v = 0; v < views->views; v++)
            *out++ = weights->constants[v] + path->sum(views, weights, v, &work.pictures[v]);
    }
    return SM_OK;
}

int32_t sm_silhouettes(const sm_body *body, const sm_views *views, const double *pose, int32_t per_view,
                       const int32_t *segments, int32_t count, uint64_t *out, void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, 1, segments, count, scratch, bytes, &work);
    if (error) return error;
    memset(out, 0, 8 * (size_t)views->word_starts[views->views]);
    take_pose(body, views, pose, per_view, 0, &work);
    path_of(views->processor)->draw(body, views, segments, count, &work);
    for (int32_t v = 0; v < views->views; v++) {
        const sm_picture *picture = &work.pictures[v];
        for (int32_t k = 0; k < picture->words; k++) {
            const int32_t *range = picture->ranges + 2 * k;
            size_t at = (size_t)picture->height * (size_t)k + (size_t)range[0];
            if (range[0] < range[1])
                memcpy(out + views->word_starts[v] + at, picture->bits + at, 8 * (size_t)(range[1] - range[0]));
        }
    }
    return SM_OK;
}

int32_t sm_outline(const sm_body *body, const sm_views *views, const double *pose, int32_t per_view,
                   const int32_t *segments, int32_t count, double spacing, sm_points *out, void *scratch, size_t bytes) {
    sm_work work;
    int32_t error = begin(body, views, 1, segments, count, scratch, bytes, &work);
    if (error) return error;
    if (!(spacing >= 1.0 / 256.0) || out->room < 0) return SM_SIZE;
    take_pose(body, views, pose, per_view, 0, &work);
    path_of(views->processor)->draw(body, views, segments, count, &work);
    path_of(views->processor)->outlines(body, views, segments, count, spacing, out, &work);
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
        clean &= path_of(views->processor)->snap(body, views, view, segments[k], work);
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
        poses = take_pose(body, views, poses, per_view, i > 0, &work);
        for (int32_t v = 0; v < views->views; v++, out += 4) bound(body, views, v, segments, count, out, &work);
    }
    return SM_OK;
}

int32_t sm_snapped(const sm_body *body, const sm_views *views, const double *pose, int32_t *out, void *scratch,
                   size_t bytes) {
    sm_work work;
    if (!path_of(views->processor)) return SM_PROCESSOR;
    if (!scratch || bytes < sm_scratch(body, views)) return SM_SCRATCH;
    sm_cut(body, views, scratch, &work);
    sm_pose_transforms(body, pose, 0, 0, 0, work.transforms);
    work.stride = 0;
    for (int32_t v = 0; v < views->views; v++) {
        for (int32_t s = 0; s < body->segments; s++) {
            path_of(views->processor)->snap(body, views, v, s, &work);
            for (int32_t i = 0; i < body->vertex_starts[s + 1] - body->vertex_starts[s]; i++) {
                *out++ = work.qx[i];
                *out++ = work.qy[i];
            }
        }
    }
    return SM_OK;
}

int32_t sm_contour_terms(const sm_targets *targets, const sm_points *points, const double *transforms, int32_t joints,
                         const int32_t *segment_joints, double *out, float *scratch) {
    if (targets->views < 1 || joints < 1 || points->starts[targets->views] > points->room) return SM_SIZE;
    const sm_path *path = path_of(targets->processor);
    if (!path) return SM_PROCESSOR;
    memset(out, 0, sizeof(double) * SM_TERMS * (size_t)joints * (size_t)targets->views);
    path->add_terms(targets, points, transforms, segment_joints, joints, out, scratch);
    return SM_OK;
}
