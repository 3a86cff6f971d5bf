/* What the parts of the kernel share; not for callers. */
#ifndef SM_INTERNAL_H
#define SM_INTERNAL_H

#include "kernel.h"

#define SM_SLOTS 16 /* crossings kept per row and segment; more take the per-triangle path */

/* One call's memory, cut from the caller's scratch. */
typedef struct {
    double *transforms; /* (J, 12) world from joint */
    uint8_t *needed;    /* (J) joints that carry a wanted segment, and their ancestors */
    int32_t *qx, *qy;   /* snapped vertices of one segment */
    int8_t *signs;      /* of the faces of one segment, and a 0 for "no face" */
    int32_t *found;     /* (records of a segment, 2) contour edges: record, directed multiplicity */
    uint8_t *counts;    /* (H) crossings of the row; all 0 between segments */
    int32_t *slots;     /* (H, SM_SLOTS) crossings: x * 8 + winding step + 4 */
    uint64_t *rows;     /* the picture, valid in the rows from y0 to y1 */
    int32_t y0, y1;
} sm_work;

/* Cuts the scratch up; returns the bytes used (with `base` null: the bytes needed). */
size_t sm_cut(const sm_body *, const sm_views *, void *base, sm_work *);

/* Marks in work->needed the joints that move the segments. */
void sm_need(const sm_body *, const int32_t *segments, int32_t count, sm_work *);

/* World from joint of one pose for the joints in `needed` (all where null). */
void sm_pose_transforms(const sm_body *, const double *pose, const uint8_t *needed, double *out);

/* What one code path offers. */
typedef struct {
    /* Draws segments of one view into work->rows, between the rows top and bottom. */
    void (*draw)(const sm_body *, const sm_views *, int32_t view, const int32_t *segments,
                 int32_t count, int32_t top, int32_t bottom, sm_work *);
    /* The weights' sum under work->rows. */
    int64_t (*sum)(const sm_views *, const sm_weights *, int32_t view, const sm_work *);
    /* Snaps the vertices of one segment into work->qx, qy; returns whether all are in the guard
       region (those that are not come out as INT32_MIN). */
    int32_t (*snap)(const sm_body *, const sm_views *, int32_t view, int32_t segment, sm_work *);
} sm_path;

extern const sm_path sm_path_base, sm_path_v3, sm_path_v4;

#endif
