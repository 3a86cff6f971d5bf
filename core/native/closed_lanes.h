/* The steps of closed.c in lanes of 512 bits: sixteen edges are judged, eight prepared and eight rows
 * of one stepped at a time, whose planes stay in registers. */
#include <immintrin.h>

#define LANES _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)

/* Sorts out the edges between faces that look different ways, and those where a face is not known. */
static int32_t find(const sm_body *body, int32_t start, int32_t clusters, const eye *e, int32_t *open, sm_work *work) {
    sm_edges *edges = &work->edges;
    uint32_t *restrict sures = edges->sure;
    int32_t *restrict opens = edges->open, n = 0, m = 0;
    const __m512 x = _mm512_set1_ps(e->at[0]), y = _mm512_set1_ps(e->at[1]), z = _mm512_set1_ps(e->at[2]);
    const __m512i sign = _mm512_set1_epi32(INT32_MIN);
    for (int32_t k = 0; k < clusters; k++) {
        int32_t cluster = work->runs[k];
        const float *restrict s = body->edge_sides + 128 * (size_t)cluster;
        const uint32_t *restrict ends = body->edge_ends + 16 * (size_t)cluster;
#define ROW(i) _mm512_loadu_ps(s + 16 * (i))
        __m512 a = _mm512_fmadd_ps(ROW(0), x, _mm512_fmadd_ps(ROW(1), y, _mm512_fmsub_ps(ROW(2), z, ROW(3))));
        __m512 b = _mm512_fmadd_ps(ROW(4), x, _mm512_fmadd_ps(ROW(5), y, _mm512_fmsub_ps(ROW(6), z, ROW(7))));
#undef ROW
        __m512 least = _mm512_range_ps(a, b, 0xa); /* the smaller of the absolute values */
        __mmask16 differ = _mm512_movepi32_mask(_mm512_castps_si512(_mm512_xor_ps(a, b)));
        __mmask16 unknown = _mm512_cmp_ps_mask(least, _mm512_set1_ps(edges->margins[cluster - start]), _CMP_NGT_UQ);
        __mmask16 sure = differ & ~unknown;
        /* a & sign | ends */
        __m512i codes = _mm512_ternarylogic_epi32(_mm512_castps_si512(a), sign, _mm512_loadu_si512(ends), 0xea);
        _mm512_storeu_si512(sures + n, _mm512_maskz_compress_epi32(sure, codes));
        n += __builtin_popcount(sure);
        _mm512_storeu_si512(opens + m, _mm512_maskz_compress_epi32(unknown, _mm512_add_epi32(_mm512_set1_epi32(16 * cluster), LANES)));
        m += __builtin_popcount(unknown);
    }
    *open = m;
    return n;
}

/* Keeps those of the open edges whose faces look different ways by their snapped areas. */
static int32_t settle(const sm_body *body, int32_t front, int32_t n, int32_t open, sm_work *work) {
    const int64_t *restrict points = work->points;
    uint32_t *restrict sure = work->edges.sure;
    for (int32_t k = 0; k < open; k++) {
        const int32_t *c = body->edge_corners + 4 * (size_t)work->edges.open[k];
        __m128i p = _mm_set1_epi64x(points[c[0]]), along = _mm_sub_epi32(_mm_set1_epi64x(points[c[1]]), p);
        __m128i apart = _mm_sub_epi32(_mm_set_epi64x(points[c[3]], points[c[2]]), p);
        __m128i one = _mm_mul_epi32(along, _mm_srli_epi64(apart, 32)), other = _mm_mul_epi32(_mm_srli_epi64(along, 32), apart);
        __m128i area = front > 0 ? _mm_sub_epi64(one, other) : _mm_sub_epi64(other, one);
        /* the second face runs the other way: its area has the other sign */
        unsigned first = _mm_cmpgt_epi64_mask(area, _mm_setzero_si128()), second = _mm_cmplt_epi64_mask(area, _mm_setzero_si128());
        first &= 1, second >>= 1;
        sure[n] = (uint32_t)(c[0] | c[1] << 16) | (first ^ 1) << 31;
        n += (int32_t)((first ^ second) & 1);
    }
    return n;
}

/* Eight edges: which cross rows, their rows, the crossings that row 0 would have and what these grow
 * by, which way the winding turns, and their columns. */
typedef struct {
    __mmask8 kept;
    __m256i row, end, low, high;
    __m512i at, slope, minus;
} crossings;

static inline crossings cross(const uint32_t *codes, int32_t front, const int64_t *points, const sm_picture *picture) {
#define P(k) points[codes[k] & 0x7fff]
#define Q(k) points[codes[k] >> 16 & 0x7fff]
    __m512i p = _mm512_setr_epi64(P(0), P(1), P(2), P(3), P(4), P(5), P(6), P(7));
    __m512i q = _mm512_setr_epi64(Q(0), Q(1), Q(2), Q(3), Q(4), Q(5), Q(6), Q(7));
#undef P
#undef Q
    const __m256i round = _mm256_set1_epi32(255), flip = _mm256_set1_epi32(front < 0 ? INT32_MIN : 0);
    const __m512d one = _mm512_set1_pd(1.0), scale = _mm512_set1_pd(0x1p46);
    __m512i above = _mm512_min_epi64(p, q), below = _mm512_max_epi64(p, q);
    __m256i xa = _mm512_cvtepi64_epi32(above), ya = _mm512_cvtepi64_epi32(_mm512_srli_epi64(above, 32));
    __m256i xb = _mm512_cvtepi64_epi32(below), yb = _mm512_cvtepi64_epi32(_mm512_srli_epi64(below, 32));
    __m256i row = _mm256_max_epi32(_mm256_srai_epi32(_mm256_add_epi32(ya, round), 8), _mm256_set1_epi32(picture->top));
    __m256i end = _mm256_min_epi32(_mm256_srai_epi32(_mm256_add_epi32(yb, round), 8), _mm256_set1_epi32(picture->bottom));
    crossings c;
    c.kept = _mm256_cmplt_epi32_mask(row, end);
    c.row = _mm256_maskz_mov_epi32(c.kept, row);
    c.end = _mm256_maskz_mov_epi32(c.kept, end);
    c.low = _mm256_min_epi32(xa, xb);
    c.high = _mm256_max_epi32(xa, xb);
    __m512d inverse = _mm512_maskz_div_pd(c.kept, one, _mm512_cvtepi32_pd(_mm256_sub_epi32(yb, ya)));
    __m512d slope = _mm512_mul_pd(_mm512_cvtepi32_pd(_mm256_sub_epi32(xb, xa)), inverse);
    __m512d down = _mm512_cvtepi32_pd(_mm256_sub_epi32(_mm256_slli_epi32(row, 8), ya));
    __m512d first = _mm512_fmadd_pd(_mm512_fmadd_pd(down, slope, _mm512_cvtepi32_pd(xa)), _mm512_set1_pd(0x1p-8), one);
    first = _mm512_fnmadd_pd(inverse, _mm512_set1_pd(0x1p-9), first);
    __mmask8 longer = _mm256_mask_cmpgt_epi32_mask(c.kept, _mm256_sub_epi32(end, row), _mm256_set1_epi32(1));
    c.slope = _mm512_maskz_cvtpd_epi64(longer, _mm512_mul_pd(slope, scale));
    c.at = _mm512_sub_epi64(_mm512_maskz_cvtpd_epi64(c.kept, _mm512_mul_pd(first, scale)),
                            _mm512_mullo_epi64(c.slope, _mm512_cvtepi32_epi64(row)));
    __mmask8 back = _mm256_movepi32_mask(_mm256_xor_si256(_mm256_loadu_si256((const __m256i *)codes), flip));
    c.minus = _mm512_movm_epi64((__mmask8)~(_mm512_cmpgt_epi64_mask(p, q) ^ back));
    return c;
}

/* Where edges cross rows, and what they reach; they go on in sixteens, those that cross none as edges
 * without rows, as is one from a vertex to itself. */
static extent take(int32_t front, int32_t n, const sm_picture *picture, sm_work *work) {
    sm_edges *e = &work->edges;
    __m256i first = _mm256_set1_epi32(INT32_MAX), last = _mm256_set1_epi32(INT32_MIN), left = first, right = last;
    _mm512_storeu_si512(e->sure + n, _mm512_setzero_si512());
    n = up_to(n, 16);
    for (int32_t i = 0; i < n; i += 8) {
        crossings c = cross(e->sure + i, front, work->points, picture);
        first = _mm256_mask_min_epi32(first, c.kept, first, c.row);
        last = _mm256_mask_max_epi32(last, c.kept, last, c.end);
        left = _mm256_mask_min_epi32(left, c.kept, left, c.low);
        right = _mm256_mask_max_epi32(right, c.kept, right, c.high);
        _mm256_storeu_si256((__m256i *)(e->row + i), c.row);
        _mm256_storeu_si256((__m256i *)(e->end + i), c.end);
        _mm512_storeu_si512(e->at + i, c.at);
        _mm512_storeu_si512(e->slope + i, c.slope);
        _mm512_storeu_si512(e->minus + i, c.minus);
    }
    __m512i low = _mm512_inserti64x4(_mm512_castsi256_si512(first), left, 1);
    __m512i high = _mm512_inserti64x4(_mm512_castsi256_si512(last), right, 1);
    return (extent){n, _mm512_mask_reduce_min_epi32(0xff, low), _mm512_mask_reduce_max_epi32(0xff, high),
                    _mm512_mask_reduce_min_epi32(0xff00, low) >> 8, (_mm512_mask_reduce_max_epi32(0xff00, high) >> 8) + 1};
}

/* Lists the edges that cross any of the eight rows from `row` on in e->sure: 256 times the edge, and
 * a mask of the rows; returns their number. */
static inline int32_t list_edges(int32_t n, int32_t row, sm_edges *e) {
    const __m512i from = _mm512_set1_epi32(row), eight = _mm512_set1_epi32(BLOCK), bits = _mm512_set1_epi32(255), zero = _mm512_setzero_si512();
    __m512i number = _mm512_slli_epi32(LANES, 8);
    int32_t listed = 0;
    for (int32_t i = 0; i < n; i += 16) {
        __m512i begin = _mm512_max_epi32(_mm512_sub_epi32(_mm512_loadu_si512(e->row + i), from), zero);
        __m512i end = _mm512_min_epi32(_mm512_sub_epi32(_mm512_loadu_si512(e->end + i), from), eight);
        __mmask16 some = _mm512_cmplt_epi32_mask(begin, end);
        __m512i rows = _mm512_and_si512(_mm512_sllv_epi32(bits, begin), _mm512_srlv_epi32(bits, _mm512_sub_epi32(eight, end)));
        _mm512_storeu_si512(e->sure + listed, _mm512_maskz_compress_epi32(some, _mm512_or_si512(rows, number)));
        listed += __builtin_popcount(some);
        number = _mm512_add_epi32(number, _mm512_set1_epi32(16 << 8));
    }
    return listed;
}

/* Eight rows of the word whose first bit is column `left`, with all bits right of every crossing
 * stepped, and each row's number of crossings. */
static inline __m512i step(int32_t n, int32_t row, int32_t left, int planes, const sm_edges *e, __m512i *counts) {
    const __m512i ones = _mm512_set1_epi64(-1), zero = _mm512_setzero_si512();
    const __m512i rows = _mm512_add_epi64(_mm512_set1_epi64(row), _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7));
    const __m512i offset = _mm512_set1_epi64((int64_t)((uint64_t)left << FRACTION));
    __m512i p0 = zero, p1 = zero, p2 = zero, count = zero;
    for (int32_t k = 0; k < n; k++) {
        size_t i = e->sure[k] >> 8;
        __mmask8 mask = (__mmask8)e->sure[k];
        __m512i at = _mm512_sub_epi64(_mm512_set1_epi64((int64_t)e->at[i]), offset), minus = _mm512_set1_epi64((int64_t)e->minus[i]);
        __m512i x = _mm512_add_epi64(at, _mm512_mullo_epi64(_mm512_set1_epi64((int64_t)e->slope[i]), rows));
        __m512i bits = _mm512_maskz_sllv_epi64(mask, ones, _mm512_max_epi64(_mm512_srai_epi64(x, FRACTION), zero));
        __m512i carry = _mm512_ternarylogic_epi64(p0, minus, bits, 0x28); /* (p0 ^ minus) & bits */
        p0 = _mm512_xor_si512(p0, bits);
        if (planes == 3) p2 = _mm512_xor_si512(p2, _mm512_ternarylogic_epi64(p1, minus, carry, 0x28));
        p1 = _mm512_xor_si512(p1, carry);
        count = _mm512_mask_sub_epi64(count, mask, count, ones);
    }
    *counts = count;
    return _mm512_or_si512(_mm512_or_si512(p0, p1), p2);
}

static inline void add(uint64_t *rows, __m512i bits) {
    _mm512_storeu_si512(rows, _mm512_or_si512(_mm512_loadu_si512(rows), bits));
}

/* Draws what lies inside the crossings, eight rows at a time; returns 0 where one has too many. */
static int cover(const extent *all, sm_picture *picture, sm_edges *e) {
    size_t height = (size_t)picture->height;
    int shift = all->left & 63;
    for (int32_t row = all->top; row < all->bottom; row += BLOCK) {
        int32_t n = list_edges(all->n, row, e), planes = 2;
        for (int32_t left = all->left; left < all->right; left += 64) {
            __m512i counts, bits = planes == 2 ? step(n, row, left, 2, e, &counts) : step(n, row, left, 3, e, &counts);
            if (planes == 2 && _mm512_cmpgt_epi64_mask(counts, _mm512_set1_epi64(MOST_OF_TWO))) {
                if (_mm512_cmpgt_epi64_mask(counts, _mm512_set1_epi64(MOST_OF_THREE))) return 0;
                planes = 3;
                bits = step(n, row, left, 3, e, &counts);
            }
            int32_t rest = picture->width - left;
            if (rest < 64) bits = _mm512_and_si512(bits, _mm512_set1_epi64((int64_t)(~0ull >> (64 - rest))));
            uint64_t *rows = picture->bits + height * (size_t)(left >> 6) + row;
            add(rows, _mm512_sll_epi64(bits, _mm_cvtsi32_si128(shift)));
            if (shift && (all->right - 1) >> 6 > left >> 6) add(rows + height, _mm512_srl_epi64(bits, _mm_cvtsi32_si128(64 - shift)));
        }
    }
    return 1;
}
