/* The native kernel: poses in, energies and silhouettes out.
 *
 * A body of segments (any triangle soup, rigid or skinned) is seen by V pinhole cameras. Vertices are projected
 * in double precision and snapped to 1/256 px; from there on a picture is defined by integers alone:
 *
 *   - the centre of pixel (x, y) lies at (256 x, 256 y);
 *   - a triangle covers a pixel whose centre lies inside it, on its left or on its top edge;
 *     a triangle of zero snapped area covers nothing;
 *   - the model covers what at least one of its triangles covers. With every triangle oriented by
 *     the sign of its snapped area, that is where the winding number is positive.
 *
 * So only edges at which the signed sum of the neighbouring triangles does not vanish (contours and
 * borders) are ever drawn, and any two implementations give equal integers. Triangles that leave
 * the region z >= near, |x|, |y| <= SM_GUARD_PX are clipped to it, in double, before snapping.
 *
 * There are no globals, no threads and no allocations: all memory is passed in and may be shared
 * read-only between threads, but for `scratch`, of which every running call needs its own. Arrays
 * are row-major. Functions that return int32_t return SM_OK or an error code.
 */
#ifndef SM_KERNEL_H
#define SM_KERNEL_H

#include <stddef.h>
#include <stdint.h>

#define SM_ABI 9
#define SM_CLUSTER 16 /* faces to a cluster */
#define SM_RUN 8      /* the records of a cluster are filled up to a multiple */
#define SM_LANES 8     /* views side by side */
#define SM_GUARD_PX 16000.0 /* 256 times this fits the snapped coordinates (22 bits and a sign) */

#if defined(_WIN32)
#define SM_API __declspec(dllexport)
#else
#define SM_API __attribute__((visibility("default")))
#endif

enum { SM_OK = 0, SM_SIZE = 1, SM_INDEX = 2, SM_SCRATCH = 3, SM_PROCESSOR = 4 };
enum { SM_TRANSLATION = 0, SM_HINGE = 1, SM_SWING = 2 };
#define SM_TERMS 50    /* numbers of one set of normal equations */
#define SM_BLOCK 32    /* points of an outline that are compared at once */

enum { SM_PLANES = 0, SM_MAPS = 1 };

/* A body at one level of detail: J joints, D degrees of freedom, S segments. Triangles lie in
 * clusters of SM_CLUSTER, each cluster's in one segment (its last one repeated to fill up), so that
 * most of them are known to face the camera, or not, at one glance. */
typedef struct {
    int32_t joints, dofs, segments, vertices, clusters, records, edge_clusters;
    const int32_t *parents;         /* (J), parents before children, -1 for the root */
    const double *offsets;          /* (J, 3) m, rest position in the parent's space */
    const int32_t *dof_starts;      /* (J + 1), joint j is moved by the rows [j] to [j + 1] */
    const int32_t *dof_kinds;       /* (D), a swing takes two rows */
    const double *dof_axes;         /* (D, 3) unit axes in the joint's space */
    const int32_t *segment_joints;  /* (S), the joint that carries the segment */
    const double *spheres;          /* (S, 4) m, centre and radius round the vertices, joint's space */
    const int32_t *vertex_starts;   /* (S + 1) */
    const int32_t *cluster_starts;  /* (S + 1) */
    const int32_t *run_starts;      /* (clusters + 1) the edge records that a cluster owns;
                                       multiples of SM_RUN */
    const float *x, *y, *z;         /* (vertices + 8) m, in the joint's space; the last ones fill up */
    const int32_t *corners;         /* (faces, 3) vertices, counted from the segment's first */
    const float *face_planes;       /* (6, faces) normal n, n . p, two factors of the margin within
                                       which the snapped triangle may face either way */
    const float *cluster_planes;    /* (8, clusters) mean normal m, m . q, max |n - m|,
                                       max |n . (p - q)|, largest factors of the margin: over all
                                       faces on either side of the cluster's records */
    const int32_t *record_vertices; /* (records, 2) p and q of an edge, counted likewise */
    const int32_t *record_faces;    /* (records, 2) a face that runs from p to q and one that runs
                                       from q to p, counted likewise; the segment's number of faces
                                       stands for "no face", twice one more for "no record" */
    const uint8_t *skinned;         /* (S) whether the segment's vertices follow several joints */
    const int32_t *skin_joints;     /* (vertices, 4) where any is skinned, which joints */
    const float *skin_weights;      /* (vertices, 4) and how much; the sum is 1 */
    const double *rests;            /* (J, 3) m, joints in the rest pose, where their axes are the
                                       world's */
    const int32_t *edge_starts;     /* (S + 1) clusters of the edges of closed segments; others
                                       have none */
    const float *edge_cones;        /* (8, edge_clusters) and 16 to fill up, like cluster_planes, of all faces beside
                                       the cluster's edges */
    const float *edge_sides;        /* (edge_clusters, 8, 16) row by row n, n . p of the face that
                                       runs from p to q, and of that which runs back */
    const uint32_t *edge_ends;      /* (edge_clusters, 16) p + 2^16 q, vertices of at most 15 bits */
    const int32_t *edge_corners;    /* (edge_clusters, 16, 4) p, q and the third of either face */
} sm_body;

/* V pinhole cameras, each with its own size. Pictures lie column by column, 64 pixels wide: pixel
 * (x, y) of view v is bit x & 63 of word word_starts[v] + (x >> 6) * H + y. What is needed for all
 * views at once lies side by side for L views, V rounded up to a multiple of SM_LANES; views that
 * fill up are copies of the first one. */
typedef struct {
    int32_t views;
    int32_t processor;          /* code path: what sm_processor() said, or a lower one */
    double near;                /* m, distance of the clipping plane in front of the camera */
    const int32_t *sizes;       /* (V, 2) px, width and height, at most 32767 */
    const double *projections;  /* (3, 4, L) world metres to homogeneous px */
    const double *planes;       /* (9, 4, L) unit planes in the world, positive inside: near, four
                                   sides of the guard region, four sides of the picture */
    const double *optics;       /* (5, L) centre in the world, det K R, largest stretch of K in px */
    const int64_t *word_starts; /* (V + 1) */
    const int64_t *map_starts;  /* (V + 1), pixels, W * H each */
    const int64_t *sum_starts;  /* (V + 1), prefix sums, (W + 1) * H each */
} sm_views;

/* Weights of V views: as two bit planes where all weights are -1, 0 or 1, else as maps. */
typedef struct {
    int32_t kind;       /* SM_PLANES: `plus`, `minus`; SM_MAPS: `maps`, `sums` */
    uint64_t *plus;     /* (words) pixels of weight +1 */
    uint64_t *minus;    /* (words) pixels of weight -1 */
    int16_t *maps;      /* (pixels), column by column */
    int32_t *sums;      /* (sums) of the weights left of each pixel, column by column */
    int64_t *constants; /* (V) energy of an empty rendering */
    int32_t *rows;      /* (V, 2) first and last row + 1 that hold a weight; set by the kernel */
} sm_weights;

/* What outlines are drawn towards: V observed contours. */
typedef struct {
    int32_t views;
    int32_t processor;          /* code path: what sm_processor() said, or a lower one */
    const int32_t *sizes;       /* (V, 2) width and height */
    const float *const *fields; /* (V) of (H, W) px from the pixel's centre to the contour, negative inside; not a
                                   number where nothing was observed */
    const int64_t *starts;      /* (V + 1) first point of each view's contour */
    const float *px, *normals;  /* (points, 2) on the contour, and away from the performer */
    const double *projections;  /* (V, 12) */
    const double *metres;       /* (V) m that a px is wide where the performer stands */
    double reach;               /* m: residuals beyond count for less and less */
    double turn;                /* m that a normal turned by a radian is away */
} sm_targets;

/* Room for points on outlines. */
typedef struct {
    int64_t room;      /* for so many */
    int64_t *starts;   /* (V + 1) where each view's begin; beyond `room` where it was too small */
    int32_t *segments; /* (room) */
    double *points;    /* (room, 3) m, in the space of the segment's joint */
    double *px;        /* (room, 2) */
    double *normals;   /* (room, 2) away from the body */
} sm_points;

SM_API int32_t sm_abi(void);           /* SM_ABI; checked at load */
SM_API const char *sm_sources(void);   /* fingerprint of the sources; a stale library is refused */
SM_API int32_t sm_processor(void);     /* best code path here: 1 any, 3 x86-64-v3, 4 x86-64-v4 */

/* Whether all indices of the body lie in range and parents come first; to be called once. */
SM_API int32_t sm_check(const sm_body *, const sm_views *);

/* Bytes of scratch that one call needs. */
SM_API size_t sm_scratch(const sm_body *, const sm_views *);

/* World from joint of n poses (n, D): out (n, J, 3, 4). */
SM_API int32_t sm_transforms(const sm_body *, const double *poses, int64_t n, double *out);

/* The same of one pose (D), and the twist that each of its DOFs adds when it grows: out (D, 6), the
 * velocity of what would be at the world's origin, and the angular velocity. */
SM_API int32_t sm_twists(const sm_body *, const double *pose, double *transforms, double *out);

/* Fills planes, or maps and prefix sums, and rows from `maps` (pixels of all views, one after the
 * other, row by row). `column` is scratch as high as the highest view. */
SM_API int32_t sm_prepare(const sm_views *, const int16_t *maps, sm_weights *out, uint64_t *column);

/* Takes fixed pixels out of the weights: out's constants become those of `in` plus the weights
 * under `fixed` (words). Windows (V, 4), x0, y0, x1, y1 (exclusive) or null: weights outside are
 * dropped. */
SM_API int32_t sm_mask(const sm_views *, const sm_weights *in, const uint64_t *fixed,
                       const int32_t *windows, sm_weights *out, uint64_t *column);

/* Energies (n, V) of poses (n, D), or (n, V, D) where per_view, of `count` segments. */
SM_API int32_t sm_energies(const sm_body *, const sm_views *, const sm_weights *,
                           const double *poses, int64_t n, int32_t per_view,
                           const int32_t *segments, int32_t count, int64_t *out, void *scratch,
                           size_t bytes);

/* What segments cover in one pose (D), or (V, D) where per_view: bits, out (words). */
SM_API int32_t sm_silhouettes(const sm_body *, const sm_views *, const double *pose,
                              int32_t per_view, const int32_t *segments, int32_t count,
                              uint64_t *out, void *scratch, size_t bytes);

/* Points on the outlines of what segments cover in one pose, at most `spacing` px apart on an edge: those
 * of edges between fronts and backs, and of borders, beside which a pixel is not covered. A segment
 * that leaves the guard region of a view, or comes too near, has none there. */
SM_API int32_t sm_outline(const sm_body *, const sm_views *, const double *pose, int32_t per_view,
                          const int32_t *segments, int32_t count, double spacing, sm_points *out, void *scratch,
                          size_t bytes);

/* Normal equations of the points' distances to the observed contours and of the contours' to the nearest
 * points, by view and joint: out (V, J, SM_TERMS) holds rows of 8, six of them, of the sums of w l (l, r, 0)', then
 * that of the robust squares and the number of distances r; r in m, and l its change with the twist of
 * the joint. `transforms` (J, 3, 4) are those of the outline, `segment_joints` carry its segments; `scratch`
 * (4, points + SM_BLOCK). */
SM_API int32_t sm_contour_terms(const sm_targets *, const sm_points *, const double *transforms, int32_t joints,
                                const int32_t *segment_joints, double *out, float *scratch);

/* Boxes (n, V, 4), x0, y0, x1, y1 (exclusive) px, unclipped by the picture, round all that the
 * segments can cover; the whole guard region where a segment leaves it or comes too near. */
SM_API int32_t sm_bounds(const sm_body *, const sm_views *, const double *poses, int64_t n,
                         int32_t per_view, const int32_t *segments, int32_t count, int32_t *out,
                         void *scratch, size_t bytes);

/* Snapped vertices of one pose (D): out (V, vertices, 2) in 1/256 px; INT32_MIN where a vertex
 * lies outside the guard region. */
SM_API int32_t sm_snapped(const sm_body *, const sm_views *, const double *pose, int32_t *out,
                          void *scratch, size_t bytes);

#endif
