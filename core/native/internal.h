/* What the parts of the kernel share; not for callers. */
#ifndef SM_INTERNAL_H
#define SM_INTERNAL_H

#include "kernel.h"

/* Where the sphere round a segment lies: out of the picture, in the guard region, or else. */
enum { HIDDEN, PLAIN, CLIPPED };

/* Which way a face looks; two are known to look the same way where the bitwise and is not 0. */
enum { UNKNOWN = 0, FRONT = 1, BACK = 2, FLAT = 3, NO_FACE = 4 };

#define SM_MOST_EDGES (1 << 24) /* of a segment's edges, numbers of 24 bits are kept */
#define SM_SLOTS 16 /* crossings kept per row and segment; more take the per-triangle path */

/* The picture of one view: of every column of words, only the rows of its range are valid, all
 * others empty. */
typedef struct {
    int32_t width, height, words; /* px, px, words to a row */
    int32_t top, bottom;          /* rows that are wanted */
    int32_t *ranges;              /* (words, 2) */
    uint64_t *bits;
} sm_picture;

/* What L views see of a segment, side by side. */
typedef struct {
    double *a;         /* (3, 4, L) joint's metres to homogeneous px */
    int32_t *where;    /* (L) HIDDEN, PLAIN or CLIPPED */
    float *at[3];      /* (L) m, the camera in the joint's space */
    float *reach;      /* (L) m, no point of the segment is farther */
    float *edge, *step; /* (L) what the two factors of the margins are multiplied by */
    float *slack;      /* (L) m, for rounding */
    int32_t *front;    /* (L) sign in the image of a triangle that shows its front */
} sm_sight;

/* Edges of a closed segment between a front and a back. */
typedef struct {
    uint32_t *sure;              /* as edge_ends, with the sign where the first face shows its back; then, of eight
                                    rows, 256 times an edge and a mask of the rows it crosses */
    int32_t *open;               /* edges where a face on either side is not known */
    float *margins;              /* m, of the clusters */
    int32_t *row, *end;          /* rows that are crossed */
    uint64_t *at, *slope;        /* 2^-46 px, first crossing and what it grows by from row to row */
    uint64_t *minus;             /* all ones where the winding falls to the right */
    uint64_t *planes[3];         /* (words, H) bits of a window: winding modulo 8; all 0 between */
    uint64_t *counts;            /* (H) crossings of the row */
    size_t rows;                 /* from word to word of a plane */
} sm_edges;

/* A skinned segment as a body of its own; see skin.c. */
typedef struct {
    sm_body body;
    float *axes[3];       /* (vertices + 8) m in the world */
    float *face_planes, *cluster_planes;
    double sphere[4], identity[12];
    int32_t vertex_starts[2], cluster_starts[2];
} sm_skin;

/* One call's memory, cut from the caller's scratch. */
typedef struct {
    double *transforms; /* (V, J, 12) world from joint, or (J, 12) */
    size_t stride;      /* from view to view in `transforms`, 0 where all see the same pose */
    uint8_t *moved;     /* (J) joints that stand otherwise than in the pose before */
    uint8_t *needed;    /* (J) joints that carry a wanted segment, and their ancestors */
    uint8_t *facing;    /* faces of one segment; then NO_FACE and, for "no record", FRONT */

    int32_t *runs;      /* clusters whose records are to be looked at */
    int32_t *found;     /* edge records that may be drawn */
    int32_t *unknown;   /* faces whose snapped area decides; signed sums of the records found */
    int32_t *places;    /* of the vertices of one segment in the next three, or -1 */
    int32_t *wanted;    /* vertices */
    int32_t *qx, *qy;   /* and where they are snapped to */
    int64_t *points;    /* all vertices of one segment in 1/256 px, y * 2^32 + x */
    uint8_t *counts;    /* (H) crossings of the row; all 0 between segments */
    int32_t *slots;     /* (H, SM_SLOTS) crossings: x * 8 + winding step + 4 */
    sm_edges edges;
    sm_skin *skin;
    sm_sight sight;
    sm_picture *pictures; /* (V) */
} sm_work;

/* Cuts the scratch up; returns the bytes used (with `base` null: the bytes needed). */
size_t sm_cut(const sm_body *, const sm_views *, void *base, sm_work *);

/* Views as they lie side by side. */
static inline size_t sm_lanes(const sm_views *views) {
    return (size_t)(views->views + SM_LANES - 1) / SM_LANES * SM_LANES;
}

/* The transform of the joint that carries a segment, as one view sees it. */
static inline const double *sm_transform(const sm_body *body, const sm_work *work, int32_t view, int32_t segment) {
    return work->transforms + work->stride * (size_t)view + 12 * (size_t)body->segment_joints[segment];
}

/* Marks in work->needed the joints that move the segments. */
void sm_need(const sm_body *, const int32_t *segments, int32_t count, sm_work *);

/* World from joint of one pose for the joints in `needed` (all where null). Where `out` holds those
 * of the `previous` pose (or null), joints that stand still are left; `moved` (J) is for that. */
void sm_pose_transforms(const sm_body *, const double *pose, const double *previous, uint8_t *moved,
                        const uint8_t *needed, double *out);

/* What one code path offers. */
typedef struct {
    /* Draws segments into the pictures of all views, segment by segment: caches hold one. */
    void (*draw)(const sm_body *, const sm_views *, const int32_t *segments, int32_t count, sm_work *);
    /* The weights' sum under one view's picture. */
    int64_t (*sum)(const sm_views *, const sm_weights *, int32_t view, const sm_picture *);
    /* Snaps the vertices of one segment into work->qx, qy; returns whether all are in the guard
       region (those that are not come out as INT32_MIN). */
    int32_t (*snap)(const sm_body *, const sm_views *, int32_t view, int32_t segment, sm_work *);
    /* Points on the outline of what has been drawn. */
    void (*outlines)(const sm_body *, const sm_views *, const int32_t *segments, int32_t count, double spacing,
                     sm_points *, sm_work *);
    /* Adds what sm_contour_terms sums up. */
    void (*add_terms)(const sm_targets *, const sm_points *, const double *transforms, const int32_t *segment_joints,
                      int32_t joints, double *out, float *scratch);
} sm_path;

extern const sm_path sm_path_base, sm_path_v3, sm_path_v4;

#endif
