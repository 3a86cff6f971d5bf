/* What the parts of the kernel share; not for callers. */
#ifndef SM_INTERNAL_H
#define SM_INTERNAL_H

#include "kernel.h"

/* Which way a face looks; two are known to look the same way where the bitwise and is not 0. */
enum { UNKNOWN = 0, FRONT = 1, BACK = 2, FLAT = 3, NO_FACE = 4 };

#define SM_SLOTS 16 /* crossings kept per row and segment; more take the per-triangle path */

/* The picture of one view; only the rows from y0 to y1 are valid, all others empty. */
typedef struct {
    int32_t width, words; /* px and words to a row */
    int32_t top, bottom;  /* rows that are wanted */
    int32_t y0, y1;
    uint64_t *rows;
} sm_picture;

/* One call's memory, cut from the caller's scratch. */
typedef struct {
    double *transforms; /* (V, J, 12) world from joint, or (J, 12) */
    size_t stride;      /* from view to view in `transforms`, 0 where all see the same pose */
    uint8_t *needed;    /* (J) joints that carry a wanted segment, and their ancestors */
    uint8_t *facing;    /* faces of one segment; then NO_FACE and, for "no record", FRONT */
    uint8_t *glances;   /* clusters of one segment: whether all faces round them look the same way */
    int32_t *runs;      /* clusters whose records are to be looked at */
    int32_t *found;     /* edge records that may be drawn */
    int32_t *unknown;   /* faces whose snapped area decides */
    int32_t *places;    /* of the vertices of one segment in the next three, or -1 */
    int32_t *wanted;    /* vertices */
    int32_t *qx, *qy;   /* and where they are snapped to */
    uint8_t *counts;    /* (H) crossings of the row; all 0 between segments */
    int32_t *slots;     /* (H, SM_SLOTS) crossings: x * 8 + winding step + 4 */
    sm_picture *pictures; /* (V) */
} sm_work;

/* Cuts the scratch up; returns the bytes used (with `base` null: the bytes needed). */
size_t sm_cut(const sm_body *, const sm_views *, void *base, sm_work *);

/* The transform of the joint that carries a segment, as one view sees it. */
static inline const double *sm_transform(const sm_body *body, const sm_work *work, int32_t view, int32_t segment) {
    return work->transforms + work->stride * (size_t)view + 12 * (size_t)body->segment_joints[segment];
}

/* Marks in work->needed the joints that move the segments. */
void sm_need(const sm_body *, const int32_t *segments, int32_t count, sm_work *);

/* World from joint of one pose for the joints in `needed` (all where null). */
void sm_pose_transforms(const sm_body *, const double *pose, const uint8_t *needed, double *out);

/* What one code path offers. */
typedef struct {
    /* Draws segments into the pictures of all views, segment by segment: caches hold one. */
    void (*draw)(const sm_body *, const sm_views *, const int32_t *segments, int32_t count, sm_work *);
    /* The weights' sum under one view's picture. */
    int64_t (*sum)(const sm_views *, const sm_weights *, int32_t view, const sm_picture *);
    /* Snaps the vertices of one segment into work->qx, qy; returns whether all are in the guard
       region (those that are not come out as INT32_MIN). */
    int32_t (*snap)(const sm_body *, const sm_views *, int32_t view, int32_t segment, sm_work *);
} sm_path;

extern const sm_path sm_path_base, sm_path_v3, sm_path_v4;

#endif
