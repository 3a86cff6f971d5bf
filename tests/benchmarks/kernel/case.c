/* One case: a scene from bytes, and what the kernel says about it on every code path. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

uint64_t *new_words(scene *s, const question *q) { return new_room(s, (size_t)q->words, 8); }

sm_weights new_weights(scene *s, const question *q, int32_t kind) {
    size_t views = (size_t)s->views.views;
    sm_weights w = {kind, 0, 0, 0, 0, new_room(s, views, 8), new_room(s, 2 * views, 4)};
    if (kind == SM_PLANES) w.plus = new_words(s, q), w.minus = new_words(s, q);
    else w.maps = new_room(s, (size_t)q->pixels, 2), w.sums = new_room(s, (size_t)q->sums, 4);
    memcpy(w.constants, q->constants, 8 * views);
    return w;
}

sm_weights prepared(scene *s, const question *q, int32_t kind) {
    sm_weights w = new_weights(s, q, kind);
    uint64_t *column = malloc(8 * (size_t)q->height);
    expect(sm_prepare(&s->views, q->maps, &w, column) == SM_OK, "weights are prepared");
    free(column);
    return w;
}

static void read_poses(reader *r, scene *s, question *q, int wild) {
    size_t dofs = (size_t)s->body.dofs, views = (size_t)s->views.views;
    q->poses = 1 + (int32_t)read_below(r, MOST_POSES);
    q->pose = new_array(s, (size_t)q->poses * dofs, 8);
    q->per_view = new_array(s, (size_t)q->poses * views * dofs, 8);
    for (size_t d = 0; d < dofs; d++) q->pose[d] = wild ? read_wild(r, 2.0) : read_number(r, 2.0);
    for (size_t n = 1; n < (size_t)q->poses; n++) {
        memcpy(q->pose + n * dofs, q->pose, 8 * dofs);
        for (uint32_t k = read_below(r, 4); k && dofs; k--)
            q->pose[n * dofs + read_below(r, (uint32_t)dofs)] = wild ? read_wild(r, 1.0) : read_number(r, 1.0);
    }
    for (size_t n = 0; n < (size_t)q->poses; n++)
        for (size_t v = 0; v < views; v++)
            memcpy(q->per_view + (n * views + v) * dofs, q->pose + (n + v) % (size_t)q->poses * dofs, 8 * dofs);
}

static void read_weights(reader *r, scene *s, question *q) {
    static const int32_t largest[] = {1, 1, 300, 32767};
    int32_t most = largest[read_below(r, 4)], shift = (int32_t)read_below(r, 3) - 1;
    uint32_t state = 1 + read_byte(r), empty = read_below(r, 4);
    q->maps = new_array(s, (size_t)q->pixels, 2);
    q->constants = new_array(s, (size_t)s->views.views, 8);
    for (int64_t i = 0; i < q->pixels; i++) {
        state = state * 1664525u + 1013904223u;
        int32_t value = (int32_t)(state >> 8) % (most + 1) * shift + (shift ? 0 : (int32_t)(state >> 9) % 3 - 1);
        q->maps[i] = (int16_t)((empty && i < q->pixels / 3) || value > most || value < -most ? 0 : value);
    }
    for (int32_t v = 0; v < s->views.views; v++) q->constants[v] = (int64_t)read_byte(r) << read_below(r, 40);
}

static void ask(reader *r, scene *s, question *q) {
    int32_t views = s->views.views;
    read_poses(r, s, q, read_below(r, 4) == 0);
    q->words = s->views.word_starts[views], q->pixels = s->views.map_starts[views], q->sums = s->views.sum_starts[views];
    q->height = 0;
    for (int32_t v = 0; v < views; v++) q->height = s->views.sizes[2 * v + 1] > q->height ? s->views.sizes[2 * v + 1] : q->height;
    read_weights(r, s, q);
    q->count = (int32_t)read_below(r, (uint32_t)s->body.segments + 1);
    for (int32_t k = 0; k < q->count; k++) q->segments[k] = (int32_t)read_below(r, (uint32_t)s->body.segments);
    q->room = (int64_t)read_below(r, 40) * (int64_t)(1 + read_below(r, 30));
    q->spacing = 0.25 * (1 + read_below(r, 60));
    q->skew = read_below(r, 8);
}

/* The calls that follow go by this code path, with scratch of just the size that it needs. */
static void go_by(scene *s, question *q, int32_t processor) {
    s->views.processor = processor;
    q->bytes = sm_scratch(&s->body, &s->views);
    q->scratch = (char *)new_room(s, q->bytes + 7, 1) + q->skew;
}

static sm_points new_points(scene *s, int64_t room) {
    size_t n = (size_t)room;
    return (sm_points){room, new_room(s, (size_t)s->views.views + 1, 8), new_room(s, n, 4), new_room(s, 3 * n, 8),
                       new_room(s, 2 * n, 8), new_room(s, 2 * n, 8)};
}

/* One code path's answers; in the second energies poses are per view. */
static answer answer_by(scene *s, question *q, const sm_weights *weights, int32_t processor) {
    size_t views = (size_t)s->views.views, n = (size_t)q->poses;
    answer a = {new_words(s, q), {new_room(s, n * views, 8), new_room(s, n * views, 8)}, new_room(s, 4 * n * views, 4),
                new_room(s, 2 * views * (size_t)s->body.vertices, 4), new_points(s, q->room)};
    go_by(s, q, processor);
    CALL(sm_snapped, q->pose, a.snapped);
    CALL(sm_bounds, q->pose, q->poses, 0, q->segments, q->count, a.bounds);
    CALL(sm_silhouettes, q->pose, 0, q->segments, q->count, a.bits);
    CALL(sm_outline, q->pose, 0, q->segments, q->count, q->spacing, &a.outline);
    CALL(sm_energies, weights, q->pose, q->poses, 0, q->segments, q->count, a.energies[0]);
    CALL(sm_energies, weights, q->per_view, q->poses, 1, q->segments, q->count, a.energies[1]);
    return a;
}

static void ask_all(reader *r, scene *s, int is_spoilt) {
    question q;
    ask(r, s, &q);
    int small = 1;
    for (int64_t i = 0; i < q.pixels; i++) small &= q.maps[i] >= -1 && q.maps[i] <= 1;
    sm_weights weights = prepared(s, &q, small ? SM_PLANES : SM_MAPS);
    answer first = answer_by(s, &q, &weights, 1);
    for (int32_t path = 3; path <= 4 && path <= sm_processor(); path++) {
        answer other = answer_by(s, &q, &weights, path);
        if (!is_spoilt) compare_answers(s, &q, &first, &other);
    }
    double *transforms = new_room(s, 12 * (size_t)q.poses * (size_t)s->body.joints, 8);
    expect(sm_transforms(&s->body, q.pose, q.poses, transforms) == SM_OK, "joints are placed");
    if (!is_spoilt) check_answers(r, s, &q, &weights, &first);
}

void run_case(const uint8_t *data, size_t size) {
    static mesh meshes[MOST_SEGMENTS];
    reader r = {data, size, 0};
    scene s = {0};
    int is_spoilt = read_below(&r, 4) == 0;
    int32_t segments = 1 + (int32_t)read_below(&r, MOST_SEGMENTS);
    s.body.joints = 1;
    read_body(&r, &s);
    read_views(&r, &s);
    int32_t *carriers = new_array(&s, (size_t)segments, 4);
    for (int32_t k = 0; k < segments; k++) {
        carriers[k] = (int32_t)read_below(&r, (uint32_t)s.body.joints);
        read_mesh(&r, meshes + k);
    }
    s.body.segment_joints = carriers;
    fill_surfaces(&s, meshes, segments);
    read_skin(&r, &s);
    if (is_spoilt) spoil(&r, &s);
    int32_t error = sm_check(&s.body, &s.views);
    if (!is_spoilt) expect(error == SM_OK, "a sound body is taken");
    if (error == SM_OK) ask_all(&r, &s, is_spoilt);
    forget(&s);
}
