/* Forward kinematics from the DOF table, in double precision. */
#include "internal.h"

#include <math.h>
#include <string.h>

/* motion = motion * rotation by the rotation vector r (Rodrigues); both 3 x 4. */
static void rotate(double *motion, const double *r) {
    double square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], angle = sqrt(square);
    if (angle == 0.0) return;
    double half = sin(0.5 * angle), s = sin(angle) / angle, c = 2.0 * half * half / square;
    double m[9] = {
        1.0 - c * (r[1] * r[1] + r[2] * r[2]), c * r[0] * r[1] - s * r[2], c * r[0] * r[2] + s * r[1],
        c * r[0] * r[1] + s * r[2], 1.0 - c * (r[0] * r[0] + r[2] * r[2]), c * r[1] * r[2] - s * r[0],
        c * r[0] * r[2] - s * r[1], c * r[1] * r[2] + s * r[0], 1.0 - c * (r[0] * r[0] + r[1] * r[1])};
    for (int i = 0; i < 3; i++) {
        double *row = motion + 4 * i, a = row[0], b = row[1], d = row[2];
        for (int j = 0; j < 3; j++) row[j] = a * m[j] + b * m[3 + j] + d * m[6 + j];
    }
}

/* motion = motion * translation by t. */
static void translate(double *motion, const double *t) {
    for (int i = 0; i < 3; i++) {
        double *row = motion + 4 * i;
        row[3] += row[0] * t[0] + row[1] * t[1] + row[2] * t[2];
    }
}

/* out = the rotation of m times v. */
static void turned(double *out, const double *m, const double *v) {
    for (int i = 0; i < 3; i++) out[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
}

static void cross(double *out, const double *a, const double *b) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void scaled_axis(double *out, const double *axis, double value) {
    for (int k = 0; k < 3; k++) out[k] = axis[k] * value;
}

/* Whether a joint stands as in the previous pose, its parent being unmoved. */
static int stands(const sm_body *body, int32_t joint, const double *pose, const double *previous) {
    for (int32_t d = body->dof_starts[joint]; d < body->dof_starts[joint + 1]; d++)
        if (pose[d] != previous[d]) return 0;
    return 1;
}

/* Where a joint stands before it moves itself. */
static void place(const sm_body *body, int32_t joint, double *transforms) {
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    int32_t parent = body->parents[joint];
    memcpy(transforms + 12 * joint, parent < 0 ? identity : transforms + 12 * parent, sizeof identity);
    translate(transforms + 12 * joint, body->offsets + 3 * joint);
}

void sm_pose_transforms(const sm_body *body, const double *pose, const double *previous, uint8_t *moved,
                        const uint8_t *needed, double *out) {
    for (int32_t j = 0; j < body->joints; j++) {
        if (needed && !needed[j]) continue;
        double *m = out + 12 * j, v[3];
        int32_t parent = body->parents[j];
        if (previous) {
            moved[j] = (parent >= 0 && moved[parent]) || !stands(body, j, pose, previous);
            if (!moved[j]) continue;
        }
        place(body, j, out);
        for (int32_t d = body->dof_starts[j]; d < body->dof_starts[j + 1]; d++) {
            const double *axis = body->dof_axes + 3 * d;
            scaled_axis(v, axis, pose[d]);
            if (body->dof_kinds[d] == SM_TRANSLATION) {
                translate(m, v);
                continue;
            }
            if (body->dof_kinds[d] == SM_SWING) {
                d++;
                for (int k = 0; k < 3; k++) v[k] += axis[3 + k] * pose[d];
            }
            rotate(m, v);
        }
    }
}

/* The axis about which the rotation vector r turns on when it grows along `axis`: the left Jacobian
 * of the rotations times the axis. */
static void turning_axis(double *out, const double *r, const double *axis) {
    double square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], angle = sqrt(square), once[3], twice[3];
    double half = sin(0.5 * angle), a = square > 1e-8 ? 2.0 * half * half / square : 0.5 - square / 24.0;
    double b = square > 1e-8 ? (angle - sin(angle)) / (square * angle) : 1.0 / 6.0 - square / 120.0;
    cross(once, r, axis);
    cross(twice, r, once);
    for (int i = 0; i < 3; i++) out[i] = axis[i] + a * once[i] + b * twice[i];
}

/* The twist of a turn about an axis, in the space of m, through its origin. */
static void put_turn(double *twist, const double *m, const double *axis) {
    double origin[3] = {m[3], m[7], m[11]};
    turned(twist + 3, m, axis);
    cross(twist, origin, twist + 3);
}

int32_t sm_twists(const sm_body *body, const double *pose, double *transforms, double *out) {
    for (int32_t j = 0; j < body->joints; j++) {
        double *m = transforms + 12 * j, v[3], axis[3];
        place(body, j, transforms);
        for (int32_t d = body->dof_starts[j]; d < body->dof_starts[j + 1]; d++) {
            const double *own = body->dof_axes + 3 * d;
            double *twist = out + 6 * d;
            scaled_axis(v, own, pose[d]);
            if (body->dof_kinds[d] == SM_TRANSLATION) {
                turned(twist, m, own);
                memset(twist + 3, 0, 3 * sizeof(double));
                translate(m, v);
                continue;
            }
            if (body->dof_kinds[d] == SM_SWING) {
                d++;
                for (int k = 0; k < 3; k++) v[k] += own[3 + k] * pose[d];
                turning_axis(axis, v, own + 3);
                put_turn(twist + 6, m, axis);
            }
            turning_axis(axis, v, own);
            put_turn(twist, m, axis);
            rotate(m, v);
        }
    }
    return SM_OK;
}

void sm_need(const sm_body *body, const int32_t *segments, int32_t count, sm_work *work) {
    memset(work->needed, 0, (size_t)body->joints);
    for (int32_t k = 0; k < count; k++) {
        int32_t s = segments[k];
        work->needed[body->segment_joints[s]] = 1;
        for (size_t i = 4 * (size_t)body->vertex_starts[s]; body->skinned[s] && i < 4 * (size_t)body->vertex_starts[s + 1]; i++)
            work->needed[body->skin_joints[i]] = 1;
    }
    for (int32_t j = body->joints - 1; j > 0; j--)
        if (work->needed[j] && body->parents[j] >= 0) work->needed[body->parents[j]] = 1;
}
