/* The steps of closed.c in lanes of 512 bits: sixteen edges are judged, eight prepared and eight rows
 * of one stepped at a time. */
#include <immintrin.h>

/* Sorts out the edges between faces that look different ways, and those where a face is not known. */
static int32_t find(const sm_body *body, int32_t start, int32_t clusters, const eye *e, sm_work *work) {
    sm_edges *edges = &work->edges;
    uint32_t *restrict sure_list = edges->sure;
    uint64_t *restrict opens = edges->open, four = 0;
    int32_t n = 0;
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
        __mmask16 open = _mm512_cmp_ps_mask(least, _mm512_set1_ps(edges->margins[cluster - start]), _CMP_NGT_UQ);
        __mmask16 sure = differ & ~open;
        /* a & sign | ends */
        __m512i codes = _mm512_ternarylogic_epi32(_mm512_castps_si512(a), sign, _mm512_loadu_si512(ends), 0xea);
        _mm512_storeu_si512(sure_list + n, _mm512_maskz_compress_epi32(sure, codes));
        n += __builtin_popcount(sure);
        four = (k & 3 ? four : 0) | (uint64_t)open << 16 * (k & 3);
        opens[k >> 2] = four;
    }
    return n;
}

/* Eight edges: which cross rows, their rows, first crossings and what these grow by, which way the
 * winding turns, and their columns. */
typedef struct {
    __mmask8 kept;
    __m256i row, end, low, high;
    __m512i at, slope, minus;
} crossings;

static inline crossings cross(__m256i code, __mmask8 some, int32_t front, const int64_t *points, const sm_picture *picture) {
    const __m256i fifteen = _mm256_set1_epi32(0x7fff), round = _mm256_set1_epi32(255);
    const __m512d one = _mm512_set1_pd(1.0), scale = _mm512_set1_pd(0x1p46);
    __m256i ip = _mm256_and_si256(code, fifteen), iq = _mm256_and_si256(_mm256_srli_epi32(code, 16), fifteen);
    __m512i p = _mm512_mask_i32gather_epi64(_mm512_setzero_si512(), some, ip, points, 8);
    __m512i q = _mm512_mask_i32gather_epi64(_mm512_setzero_si512(), some, iq, points, 8);
    __m512i above = _mm512_min_epi64(p, q), below = _mm512_max_epi64(p, q);
    __m256i xa = _mm512_cvtepi64_epi32(above), ya = _mm512_cvtepi64_epi32(_mm512_srli_epi64(above, 32));
    __m256i xb = _mm512_cvtepi64_epi32(below), yb = _mm512_cvtepi64_epi32(_mm512_srli_epi64(below, 32));
    crossings c;
    c.row = _mm256_max_epi32(_mm256_srai_epi32(_mm256_add_epi32(ya, round), 8), _mm256_set1_epi32(picture->top));
    c.end = _mm256_min_epi32(_mm256_srai_epi32(_mm256_add_epi32(yb, round), 8), _mm256_set1_epi32(picture->bottom));
    c.kept = _mm256_mask_cmplt_epi32_mask(some, c.row, c.end);
    c.low = _mm256_min_epi32(xa, xb);
    c.high = _mm256_max_epi32(xa, xb);
    __m512d inverse = _mm512_maskz_div_pd(c.kept, one, _mm512_cvtepi32_pd(_mm256_sub_epi32(yb, ya)));
    __m512d slope = _mm512_mul_pd(_mm512_cvtepi32_pd(_mm256_sub_epi32(xb, xa)), inverse);
    __m512d down = _mm512_cvtepi32_pd(_mm256_sub_epi32(_mm256_slli_epi32(c.row, 8), ya));
    __m512d first = _mm512_fmadd_pd(_mm512_fmadd_pd(down, slope, _mm512_cvtepi32_pd(xa)), _mm512_set1_pd(0x1p-8), one);
    first = _mm512_fnmadd_pd(inverse, _mm512_set1_pd(0x1p-9), first);
    __mmask8 longer = _mm256_mask_cmpgt_epi32_mask(c.kept, _mm256_sub_epi32(c.end, c.row), _mm256_set1_epi32(1));
    c.at = _mm512_maskz_cvtpd_epi64(c.kept, _mm512_mul_pd(first, scale));
    c.slope = _mm512_maskz_cvtpd_epi64(longer, _mm512_mul_pd(slope, scale));
    __mmask8 back = _mm256_movepi32_mask(_mm256_xor_si256(code, _mm256_set1_epi32(front < 0 ? INT32_MIN : 0)));
    c.minus = _mm512_movm_epi64((__mmask8)~(_mm512_cmpgt_epi64_mask(p, q) ^ back));
    return c;
}

/* Puts down the blocks of rows of eight edges from place n on: the block's first row, a mask of its
 * rows, and the crossing of its first row; returns how many there are then. */
static inline int32_t put_blocks(crossings c, int32_t n, sm_edges *e) {
    const __m256i seven = _mm256_set1_epi32(BLOCK - 1), bits = _mm256_set1_epi32(255);
    __m256i skipped = _mm256_and_si256(c.row, seven), inside = _mm256_sllv_epi32(bits, skipped);
    c.row = _mm256_andnot_si256(seven, c.row);
    c.at = _mm512_sub_epi64(c.at, _mm512_mullo_epi64(c.slope, _mm512_cvtepi32_epi64(skipped)));
    while (c.kept) {
        __m256i mask = _mm256_andnot_si256(_mm256_sllv_epi32(bits, _mm256_sub_epi32(c.end, c.row)), inside);
        _mm512_storeu_si512(e->at + n, _mm512_maskz_compress_epi64(c.kept, c.at));
        _mm512_storeu_si512(e->slope + n, _mm512_maskz_compress_epi64(c.kept, c.slope));
        _mm512_storeu_si512(e->minus + n, _mm512_maskz_compress_epi64(c.kept, c.minus));
        _mm256_storeu_si256((__m256i *)(e->row + n), _mm256_maskz_compress_epi32(c.kept, c.row));
        _mm256_storeu_si256((__m256i *)(e->end + n), _mm256_maskz_compress_epi32(c.kept, mask));
        n += __builtin_popcount(c.kept);
        c.row = _mm256_add_epi32(c.row, _mm256_set1_epi32(BLOCK));
        c.at = _mm512_add_epi64(c.at, _mm512_slli_epi64(c.slope, 3));
        c.kept = _mm256_mask_cmplt_epi32_mask(c.kept, c.row, c.end);
        inside = bits;
    }
    return n;
}

/* Where edges cross rows, and what they reach; n is -1 where there are too many blocks. */
static extent take(int32_t front, int32_t n, const sm_picture *picture, sm_work *work) {
    sm_edges *e = &work->edges;
    __m256i first = _mm256_set1_epi32(INT32_MAX), last = _mm256_set1_epi32(INT32_MIN), left = first, right = last;
    __m256i length = _mm256_setzero_si256();
    int32_t put = 0;
    for (int32_t i = 0; i < n; i += 8) {
        __mmask8 some = (__mmask8)(n - i < 8 ? (1 << (n - i)) - 1 : 255);
        __m256i code = _mm256_loadu_si256((const __m256i *)(e->sure + i));
        crossings c = cross(code, some, front, work->points, picture);
        first = _mm256_mask_min_epi32(first, c.kept, first, c.row);
        last = _mm256_mask_max_epi32(last, c.kept, last, c.end);
        left = _mm256_mask_min_epi32(left, c.kept, left, c.low);
        right = _mm256_mask_max_epi32(right, c.kept, right, c.high);
        length = _mm256_mask_add_epi32(length, c.kept, length, _mm256_sub_epi32(c.end, c.row));
        if ((size_t)put + 8 * (size_t)(picture->height / BLOCK + 2) > e->most) return (extent){-1, 0, 0, 0, 0, 0};
        put = put_blocks(c, put, e);
    }
    __m512i low = _mm512_inserti64x4(_mm512_castsi256_si512(first), left, 1);
    __m512i high = _mm512_inserti64x4(_mm512_castsi256_si512(last), right, 1);
    return (extent){put, _mm512_mask_reduce_min_epi32(0xff, low), _mm512_mask_reduce_max_epi32(0xff, high),
                    _mm512_mask_reduce_min_epi32(0xff00, low) >> 8, (_mm512_mask_reduce_max_epi32(0xff00, high) >> 8) + 1,
                    _mm512_mask_reduce_add_epi32(0xff, _mm512_zextsi256_si512(length))};
}

/* Steps all bits right of every crossing, in the word of each row whose first bit is column `left`. */
static inline void step(int32_t n, int32_t word, int32_t left, int planes, int counted, sm_edges *e) {
    size_t start = e->rows * (size_t)word;
    uint64_t *restrict p0 = e->planes[0] + start, *restrict p1 = e->planes[1] + start, *restrict p2 = e->planes[2] + start;
    uint64_t *restrict counts = e->counts;
    const __m512i lanes = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7), ones = _mm512_set1_epi64(-1), zero = _mm512_setzero_si512();
    const __m512i offset = _mm512_set1_epi64((int64_t)((uint64_t)left << FRACTION));
    for (int32_t i = 0; i < n; i++) {
        size_t block = (size_t)e->row[i];
        __mmask8 mask = (__mmask8)e->end[i];
        __m512i minus = _mm512_set1_epi64((int64_t)e->minus[i]), slope = _mm512_set1_epi64((int64_t)e->slope[i]);
        __m512i x = _mm512_add_epi64(_mm512_sub_epi64(_mm512_set1_epi64((int64_t)e->at[i]), offset), _mm512_mullo_epi64(slope, lanes));
        __m512i bits = _mm512_maskz_sllv_epi64(mask, ones, _mm512_max_epi64(_mm512_srai_epi64(x, FRACTION), zero));
        __m512i was = _mm512_loadu_si512(p0 + block), high = _mm512_loadu_si512(p1 + block);
        __m512i carry = _mm512_ternarylogic_epi64(was, minus, bits, 0x28); /* (was ^ minus) & bits */
        _mm512_storeu_si512(p0 + block, _mm512_xor_si512(was, bits));
        if (planes == 3) {
            __m512i top = _mm512_loadu_si512(p2 + block), over = _mm512_ternarylogic_epi64(high, minus, carry, 0x28);
            _mm512_storeu_si512(p2 + block, _mm512_xor_si512(top, over));
        }
        _mm512_storeu_si512(p1 + block, _mm512_xor_si512(high, carry));
        if (counted) {
            __m512i c = _mm512_loadu_si512(counts + block);
            _mm512_storeu_si512(counts + block, _mm512_mask_sub_epi64(c, mask, c, ones));
        }
    }
}
