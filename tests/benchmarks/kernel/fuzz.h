/* The fuzzer of the kernel: bytes in, a scene out, every entry point called and compared. */
#ifndef FUZZ_H
#define FUZZ_H

#include "kernel.h"

#include <stddef.h>
#include <stdint.h>

enum { MOST_VERTICES = 512, MOST_FACES = 640, MOST_RECORDS = 3 * MOST_FACES, MOST_SEGMENTS = 4, MOST_POSES = 3, MOST_ARRAYS = 128 };

/* Bytes that are turned into a scene; zeros follow them. */
typedef struct {
    const uint8_t *data;
    size_t size, at;
} reader;

uint32_t read_byte(reader *);
uint32_t read_below(reader *, uint32_t n);    /* 0 to n - 1 */
double read_number(reader *, double largest); /* -largest to largest, in steps */
double read_wild(reader *, double largest);   /* the same, or one of the numbers nobody expects */

/* One segment's triangles. */
typedef struct {
    int32_t vertices, faces;
    float at[MOST_VERTICES][3];
    int32_t corners[MOST_FACES][3];
} mesh;

/* A body and its views; every array lies in a block of its own, of its own size. */
typedef struct {
    sm_body body;
    sm_views views;
    void *arrays[MOST_ARRAYS];
    int32_t sizes[MOST_ARRAYS]; /* of those which hold 32-bit numbers; 0 of others */
    int32_t count;
} scene;

void *new_room(scene *, size_t count, size_t size);  /* not filled */
void *new_array(scene *, size_t count, size_t size); /* all 0 */
void read_mesh(reader *, mesh *);
void read_body(reader *, scene *);
void read_skin(reader *, scene *);
void read_views(reader *, scene *);
void fill_surfaces(scene *, const mesh *, int32_t segments);
void spoil(reader *, scene *);
void forget(scene *);

/* A call's arguments, and all answers of one code path. */
typedef struct {
    int32_t poses, count, segments[MOST_SEGMENTS + 1];
    double *pose, *per_view;
    int64_t words, pixels, sums, height;
    int16_t *maps;
    int64_t *constants, room;
    double spacing;
    void *scratch;
    size_t bytes, skew; /* of the scratch, and of its begin */
} question;

typedef struct {
    uint64_t *bits;
    int64_t *energies[2];
    int32_t *bounds, *snapped;
    sm_points outline;
} answer;

#define CALL(name, ...) expect(name(&s->body, &s->views, __VA_ARGS__, q->scratch, q->bytes) == SM_OK, #name " answers")

uint64_t *new_words(scene *, const question *);
sm_weights new_weights(scene *, const question *, int32_t kind);
sm_weights prepared(scene *, const question *, int32_t kind);

/* Runs one case; ends the process where the kernel contradicts itself. */
void run_case(const uint8_t *data, size_t size);

/* What two code paths say of one scene must be the same bits. */
void compare_answers(const scene *, const question *, const answer *, const answer *);

/* What one says must fit together, and what its triangles cover by definition. */
void check_answers(reader *, scene *, question *, const sm_weights *, const answer *);

/* Says what is wrong and ends the process. */
void fail(const char *what);
void expect(int holds, const char *what);

#endif
