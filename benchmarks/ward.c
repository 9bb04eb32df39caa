/* Ward's model with the angles fixed, by hand: the bar for machine code that brdfc makes. */
#include <string.h>

/* e^x as 2^n e^r, by a polynomial that is good to one unit in the last place of float. */
static inline float exponential(float x) {
    x = x < -104.0f ? -104.0f : x;
    x = x > 89.0f ? 89.0f : x;
    float shifted = x * 1.44269504f + 12582912.0f; /* 1.5 2^23 */
    float n = shifted - 12582912.0f;
    float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
    float p = 1.9875691500e-4f;
    p = p * r + 1.3981999507e-3f;
    p = p * r + 8.3334519073e-3f;
    p = p * r + 4.1665795894e-2f;
    p = p * r + 1.6666665459e-1f;
    p = p * r + 5.0000001201e-1f;
    p = p * r * r + r + 1.0f;
    int bits, half, rest, a, b;
    float fa, fb;
    memcpy(&bits, &shifted, 4);
    half = (bits - 0x4B400000) / 2; /* in two factors, for results that are subnormal */
    rest = (bits - 0x4B400000) - half;
    a = (half + 127) << 23;
    b = (rest + 127) << 23;
    memcpy(&fa, &a, 4);
    memcpy(&fb, &b, 4);
    return p * fa * fb;
}

/* radiance = (Rd/pi + white ks e^(t/m^2) / (m^2 s)) c */
void ward(const float *restrict x, const float *restrict y, const float *restrict z,
          const float *restrict ks, const float *restrict m, float *restrict X,
          float *restrict Y, float *restrict Z, long count, float t, float s, float c) {
    for (long i = 0; i < count; i++) {
        float square = m[i] * m[i];
        float lobe = ks[i] / (square * exponential(-t / square) * s);
        X[i] = (x[i] * 0.31830987f + 0.9642f * lobe) * c;
        Y[i] = (y[i] * 0.31830987f + lobe) * c;
        Z[i] = (z[i] * 0.31830987f + 0.8249f * lobe) * c;
    }
}

/* Five planes read, three written, next to nothing computed: what memory allows. */
void copy(const float *restrict x, const float *restrict y, const float *restrict z,
          const float *restrict ks, const float *restrict m, float *restrict X,
          float *restrict Y, float *restrict Z, long count) {
    for (long i = 0; i < count; i++) {
        float both = ks[i] + m[i];
        X[i] = x[i] + both;
        Y[i] = y[i] + both;
        Z[i] = z[i] + both;
    }
}
