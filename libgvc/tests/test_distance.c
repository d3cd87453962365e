/* SPDX-License-Identifier: MIT */
/** @file test_distance.c  Closest points, surface samples and the distance between two meshes. */
#include "mesh/distance.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* cmocka 1.1's assert_float_equal compares in single precision. NaN is never near. */
#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        double value_ = (value), expected_ = (expected);                                           \
        if (!(fabs(value_ - expected_) <= (tolerance))) {                                          \
            fail_msg("%s is %.17g, not %.17g", #value, value_, expected_);                         \
        }                                                                                          \
    } while (0)

/* ------------------------------------------------------------------------------------- meshes */

static gvc_mesh *make(const double *positions, size_t vertices, const uint32_t *faces,
                      size_t face_count) {
    gvc_mesh *mesh = NULL;
    assert_int_equal(gvc_mesh_create(positions, vertices, faces, face_count, &mesh, NULL), GVC_OK);
    return mesh;
}

/* Uniform in [0, 1), the same on every machine. */
static double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* Unit cube with two triangles a side, moved along x. */
static gvc_mesh *make_cube(double shift) {
    double positions[24];
    for (int v = 0; v < 8; v++) {
        positions[3 * v] = (v & 1) + shift;
        positions[3 * v + 1] = v >> 1 & 1;
        positions[3 * v + 2] = v >> 2 & 1;
    }
    static const uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return make(positions, 8, faces, 12);
}

/* Square [0, side]^2 in the plane z = height. */
static gvc_mesh *make_square(double side, double height) {
    const double positions[12] = {0,    0,    height, side, 0,    height,
                                  side, side, height, 0,    side, height};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    return make(positions, 4, faces, 2);
}

/* Sphere about the origin: `rings` latitudes of 2 * rings quads each, poles included. */
static gvc_mesh *make_sphere(uint32_t rings, double radius) {
    uint32_t around = 2 * rings;
    double *positions = calloc(3 * (size_t)(rings + 1) * around, sizeof *positions);
    uint32_t *faces = calloc(6 * (size_t)rings * around, sizeof *faces);
    assert_non_null(positions);
    assert_non_null(faces);
    const double pi = acos(-1.0);
    size_t count = 0;
    for (uint32_t i = 0; i <= rings; i++) {
        for (uint32_t j = 0; j < around; j++) {
            double theta = pi * i / rings, phi = 2 * pi * j / around;
            double *p = positions + 3 * ((size_t)i * around + j);
            p[0] = radius * sin(theta) * cos(phi);
            p[1] = radius * sin(theta) * sin(phi);
            p[2] = radius * cos(theta);
            if (i == rings) continue;
            uint32_t next = (j + 1) % around;
            const uint32_t quad[6] = {i * around + j,          (i + 1) * around + j,
                                      (i + 1) * around + next, i * around + j,
                                      (i + 1) * around + next, i * around + next};
            memcpy(faces + count, quad, sizeof quad);
            count += 6;
        }
    }
    gvc_mesh *mesh = make(positions, (size_t)(rings + 1) * around, faces, count / 3);
    free(positions);
    free(faces);
    return mesh;
}

/* Triangles anywhere in the unit cube; every fifth is a sliver, every seventh a point or segment.
 */
static gvc_mesh *make_soup(size_t count, uint64_t seed) {
    double *positions = calloc(9 * count, sizeof *positions);
    uint32_t *faces = calloc(3 * count, sizeof *faces);
    assert_non_null(positions);
    assert_non_null(faces);
    for (size_t f = 0; f < count; f++) {
        double *p = positions + 9 * f;
        for (int k = 0; k < 3; k++) {
            p[k] = uniform(&seed);
            p[3 + k] = p[k] + 0.2 * (uniform(&seed) - 0.5);
            p[6 + k] = p[k] + 0.2 * (uniform(&seed) - 0.5);
            double along = 0.5 * p[k] + 0.5 * p[3 + k];
            if (f % 5 == 0) p[6 + k] = along + 1e-6 * (uniform(&seed) - 0.5);
            if (f % 7 == 0) p[6 + k] = f % 2 ? p[k] : along;
            if (f % 35 == 0) p[3 + k] = p[6 + k] = p[k];
        }
        for (uint32_t c = 0; c < 3; c++) faces[3 * f + c] = (uint32_t)(3 * f) + c;
    }
    gvc_mesh *mesh = make(positions, 3 * count, faces, count);
    free(positions);
    free(faces);
    return mesh;
}

static void corner_of(const gvc_mesh *mesh, size_t f, int c, double position[3]) {
    uint32_t v = gvc_mesh_faces(mesh)[3 * f + (size_t)c];
    memcpy(position, gvc_mesh_positions(mesh) + 3 * (size_t)v, 3 * sizeof *position);
}

/* -------------------------------------------------------------------------------- brute force */

static double norm(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static double segment_distance(const double p[3], const double a[3], const double b[3]) {
    double length = 0, t = 0, off[3];
    for (int k = 0; k < 3; k++) {
        length += (b[k] - a[k]) * (b[k] - a[k]);
        t += (b[k] - a[k]) * (p[k] - a[k]);
    }
    t = length > 0 ? fmin(fmax(t / length, 0), 1) : 0;
    for (int k = 0; k < 3; k++) off[k] = a[k] + t * (b[k] - a[k]) - p[k];
    return norm(off);
}

/* Least distance to the three edges and, if the normal equations put it inside, to the plane. */
static double triangle_distance(const double p[3], const double a[3], const double b[3],
                                const double c[3]) {
    double best = segment_distance(p, a, b);
    best = fmin(best, segment_distance(p, b, c));
    best = fmin(best, segment_distance(p, c, a));
    long double uu = 0, uv = 0, vv = 0, ur = 0, vr = 0;
    for (int k = 0; k < 3; k++) {
        long double u = (long double)b[k] - a[k], v = (long double)c[k] - a[k];
        long double r = (long double)p[k] - a[k];
        uu += u * u, uv += u * v, vv += v * v, ur += u * r, vr += v * r;
    }
    long double determinant = uu * vv - uv * uv;
    if (determinant <= 1e-17L * uu * vv) return best;
    long double s = (ur * vv - vr * uv) / determinant, t = (vr * uu - ur * uv) / determinant;
    if (s < 0 || t < 0 || s + t > 1) return best;
    double off[3];
    for (int k = 0; k < 3; k++) {
        off[k] = (double)(a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]) - p[k]);
    }
    return fmin(best, norm(off));
}

static double brute_force(const gvc_mesh *mesh, const double p[3]) {
    double best = HUGE_VAL;
    for (size_t f = 0; f < gvc_mesh_face_count(mesh); f++) {
        double corner[3][3];
        for (int c = 0; c < 3; c++) corner_of(mesh, f, c, corner[c]);
        best = fmin(best, triangle_distance(p, corner[0], corner[1], corner[2]));
    }
    return best;
}

/* The parts of an answer must agree with each other. */
static void check_consistent(const gvc_mesh *mesh, const double p[3], const gvc_closest *closest) {
    double off[3], at[3] = {0}, sum = 0;
    assert_true(closest->face < gvc_mesh_face_count(mesh));
    for (int c = 0; c < 3; c++) {
        double corner[3];
        corner_of(mesh, closest->face, c, corner);
        assert_true(closest->barycentric[c] >= 0);
        sum += closest->barycentric[c];
        for (int k = 0; k < 3; k++) at[k] += closest->barycentric[c] * corner[k];
    }
    assert_near(sum, 1, 1e-12);
    for (int k = 0; k < 3; k++) {
        assert_near(at[k], closest->point[k], 1e-12);
        off[k] = p[k] - closest->point[k];
    }
    assert_near(norm(off), closest->distance, 1e-12);
}

static void compare_with_brute_force(const gvc_mesh *mesh, size_t queries, double spread) {
    gvc_bvh *bvh = NULL;
    uint64_t seed = 7;
    assert_int_equal(gvc_bvh_create(mesh, &bvh, NULL), GVC_OK);
    for (size_t i = 0; i < queries; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = spread * (uniform(&seed) - 0.5) + 0.5;
        gvc_closest closest;
        assert_true(gvc_bvh_closest(bvh, p, NULL, HUGE_VAL, &closest));
        assert_near(closest.distance, brute_force(mesh, p), 1e-9);
        check_consistent(mesh, p, &closest);
    }
    gvc_bvh_destroy(&bvh);
    assert_null(bvh);
}

static void closest_matches_brute_force_on_a_soup(void **state) {
    (void)state;
    gvc_mesh *soup = make_soup(700, 1);
    compare_with_brute_force(soup, 400, 1);
    compare_with_brute_force(soup, 400, 50);
    gvc_mesh_destroy(&soup);
}

static void closest_matches_brute_force_on_a_sphere(void **state) {
    (void)state;
    gvc_mesh *sphere = make_sphere(20, 1);
    compare_with_brute_force(sphere, 400, 3);
    gvc_mesh_destroy(&sphere);
}

static void closest_matches_brute_force_for_one_to_nine_faces(void **state) {
    (void)state;
    for (size_t count = 1; count < 10; count++) {
        gvc_mesh *soup = make_soup(count, count);
        compare_with_brute_force(soup, 50, 2);
        gvc_mesh_destroy(&soup);
    }
}

/* Faces at 1, 1/2, 1/4, ... and many equal faces would make a naive hierarchy as deep as they are
 * many. */
static void hierarchy_stays_shallow_on_spiteful_meshes(void **state) {
    (void)state;
    enum { COUNT = 2000 };
    double *positions = calloc(9 * COUNT, sizeof *positions);
    uint32_t *faces = calloc(3 * COUNT, sizeof *faces);
    assert_non_null(positions);
    assert_non_null(faces);
    for (uint32_t f = 0; f < COUNT; f++) {
        double scale = f < COUNT / 2 ? ldexp(1, -(int)(f % 1000)) : 1;
        double *p = positions + 9 * (size_t)f;
        p[0] = p[3] = p[6] = scale;
        p[4] = p[8] = scale * 0.25;
        for (uint32_t c = 0; c < 3; c++) faces[3 * f + c] = 3 * f + c;
    }
    gvc_mesh *mesh = make(positions, 3 * (size_t)COUNT, faces, COUNT);
    compare_with_brute_force(mesh, 200, 2);
    gvc_mesh_destroy(&mesh);
    free(positions);
    free(faces);
}

static void limit_is_inclusive_and_respected(void **state) {
    (void)state;
    gvc_mesh *soup = make_soup(200, 3);
    gvc_bvh *bvh = NULL;
    uint64_t seed = 11;
    assert_int_equal(gvc_bvh_create(soup, &bvh, NULL), GVC_OK);
    for (int i = 0; i < 500; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = 2 * uniform(&seed);
        gvc_closest closest, again;
        assert_true(gvc_bvh_closest(bvh, p, NULL, HUGE_VAL, &closest));
        assert_true(gvc_bvh_closest(bvh, p, NULL, closest.distance, &again));
        assert_true(again.distance == closest.distance);
        assert_false(gvc_bvh_closest(bvh, p, NULL, closest.distance * (1 - 1e-12), &again));
    }
    double nowhere[3] = {NAN, 0, 0}, origin[3] = {0, 0, 0};
    gvc_closest closest;
    assert_false(gvc_bvh_closest(bvh, nowhere, NULL, HUGE_VAL, &closest));
    assert_false(gvc_bvh_closest(bvh, origin, NULL, -1, &closest));
    assert_false(gvc_bvh_closest(bvh, origin, NULL, NAN, &closest));
    gvc_bvh_destroy(&bvh);
    gvc_mesh_destroy(&soup);
}

static void normal_leaves_out_faces_that_look_away(void **state) {
    (void)state;
    gvc_mesh *cube = make_cube(0);
    gvc_bvh *bvh = NULL;
    assert_int_equal(gvc_bvh_create(cube, &bvh, NULL), GVC_OK);
    /* Just above the bottom, whose normal is -z; the top is far, but looks the right way. */
    const double p[3] = {0.5, 0.5, 0.1}, up[3] = {0, 0, 1}, tilted[3] = {1e-3, 2e-3, 1};
    gvc_closest closest;
    assert_true(gvc_bvh_closest(bvh, p, NULL, HUGE_VAL, &closest));
    assert_near(closest.distance, 0.1, 1e-15);
    assert_true(gvc_bvh_closest(bvh, p, tilted, HUGE_VAL, &closest));
    assert_near(closest.distance, 0.5, 1e-15); /* the walls x = 1 and y = 1 */
    const double high[3] = {0.5, 0.5, 0.9};
    assert_true(gvc_bvh_closest(bvh, high, up, HUGE_VAL, &closest));
    assert_near(closest.distance, 0.1, 1e-15);
    assert_near(closest.point[2], 1, 1e-15);
    gvc_bvh_destroy(&bvh);
    gvc_mesh_destroy(&cube);

    gvc_mesh *square = make_square(1, 0);
    assert_int_equal(gvc_bvh_create(square, &bvh, NULL), GVC_OK);
    const double down[3] = {0, 0, -1};
    assert_true(gvc_bvh_closest(bvh, p, up, HUGE_VAL, &closest));
    assert_false(gvc_bvh_closest(bvh, p, down, HUGE_VAL, &closest));
    gvc_bvh_destroy(&bvh);
    gvc_mesh_destroy(&square);
}

static void no_faces_means_no_closest_point(void **state) {
    (void)state;
    gvc_mesh *empty = make(NULL, 0, NULL, 0);
    gvc_bvh *bvh = NULL;
    assert_int_equal(gvc_bvh_create(empty, &bvh, NULL), GVC_OK);
    const double p[3] = {0};
    gvc_closest closest;
    assert_false(gvc_bvh_closest(bvh, p, NULL, HUGE_VAL, &closest));
    gvc_bvh_destroy(&bvh);
    gvc_bvh_destroy(&bvh);
    gvc_bvh_destroy(NULL);
    gvc_mesh_destroy(&empty);
}

/* ------------------------------------------------------------------------------------ samples */

static void samples_are_spread_by_area(void **state) {
    (void)state;
    enum { COUNT = 6400, CELLS = 8 };
    /* The unit square as faces of area 1/2, 0, 3/8, 1/8 and 0. */
    const double positions[18] = {0, 0, 2, 1, 0, 2, 1, 1, 2, 0, 1, 2, 0.25, 1, 2, 0.5, 0.5, 2};
    const uint32_t faces[15] = {0, 1, 2, 0, 5, 2, 0, 2, 4, 0, 4, 3, 3, 3, 4};
    gvc_mesh *square = make(positions, 6, faces, 5);
    double *points = calloc(3 * COUNT, sizeof *points);
    assert_non_null(points);
    assert_int_equal(gvc_mesh_sample(square, COUNT, points, NULL), GVC_OK);
    int lower = 0, cells[CELLS][CELLS] = {{0}};
    double worst = 0;
    for (int i = 0; i < COUNT; i++) {
        const double *p = points + 3 * i;
        assert_true(p[0] >= 0 && p[0] < 1 && p[1] >= 0 && p[1] <= 1);
        assert_near(p[2], 2, 1e-12);
        if (p[1] < p[0]) lower++;
        cells[(int)(p[1] * (1 - 1e-12) * CELLS)][(int)(p[0] * CELLS)]++;
    }
    assert_in_range(lower, COUNT / 2 - 1, COUNT / 2 + 1);
    for (int i = 0; i < CELLS * CELLS; i++) {
        worst = fmax(worst, fabs(cells[i / CELLS][i % CELLS] - COUNT / (double)(CELLS * CELLS)));
    }
    /* Independent random points would stray by 10 in a typical cell and 25 in the worst. */
    assert_true(worst <= 12);
    free(points);
    gvc_mesh_destroy(&square);
}

static void samples_need_an_area(void **state) {
    (void)state;
    double point[3];
    gvc_error error;
    gvc_error_init(&error);
    gvc_mesh *empty = make(NULL, 0, NULL, 0);
    assert_int_equal(gvc_mesh_sample(empty, 1, point, &error), GVC_ERROR_MESH);
    assert_int_equal(error.code, GVC_ERROR_MESH);
    assert_int_equal(gvc_mesh_sample(empty, 0, NULL, NULL), GVC_OK);
    gvc_mesh_destroy(&empty);

    gvc_mesh *huge = make_square(1e200, 0);
    assert_int_equal(gvc_mesh_sample(huge, 1, point, &error), GVC_ERROR_MESH);
    gvc_mesh_destroy(&huge);
}

/* ----------------------------------------------------------------------------------- distance */

static gvc_distance measure(const gvc_mesh *first, const gvc_mesh *second, size_t samples) {
    gvc_distance distance;
    assert_int_equal(gvc_mesh_distance(first, second, samples, &distance, NULL), GVC_OK);
    return distance;
}

static void parallel_squares_are_their_offset_apart(void **state) {
    (void)state;
    gvc_mesh *low = make_square(2, 0), *high = make_square(2, 0.125);
    gvc_distance d = measure(low, high, 1000);
    for (int way = 0; way < 2; way++) {
        assert_near(d.mean[way], 0.125, 1e-14);
        assert_near(d.rms[way], 0.125, 1e-14);
        assert_near(d.maximum[way], 0.125, 1e-14);
    }
    assert_near(d.diagonal, sqrt(8), 1e-14);
    gvc_mesh_destroy(&low);
    gvc_mesh_destroy(&high);
}

static void directions_are_kept_apart(void **state) {
    (void)state;
    gvc_mesh *large = make_square(1, 0), *small = make_square(0.5, 0);
    gvc_distance d = measure(large, small, 0);
    assert_near(d.mean[1], 0, 1e-14);
    assert_near(d.maximum[1], 0, 1e-14);
    assert_near(d.maximum[0], 0.5 * sqrt(2), 1e-14); /* at the vertex (1, 1) */
    /* The square of a distance is max(x - 1/2, 0)^2 + max(y - 1/2, 0)^2. */
    assert_near(d.rms[0], sqrt(2.0 / 24), 1e-3);
    gvc_mesh_destroy(&large);
    gvc_mesh_destroy(&small);
}

/* With s the shift: the four walls along it are s - x away where x < s, one end is s away, and the
 * other, inside the other cube, is min(s, way to the nearest wall) away. */
static void shifted_cube_matches_the_integrals(void **state) {
    (void)state;
    const double s = 0.2;
    gvc_mesh *cube = make_cube(0), *shifted = make_cube(s);
    gvc_distance d = measure(cube, shifted, 0);
    double mean = (4 * s * s / 2 + s + (1 - pow(1 - 2 * s, 3)) / 6) / 6;
    double square = (4 * s * s * s / 3 + s * s + s * s - 8 * s * s * s / 3 + 2 * pow(s, 4)) / 6;
    for (int way = 0; way < 2; way++) {
        assert_near(d.mean[way], mean, 2e-3 * mean);
        assert_near(d.rms[way], sqrt(square), 2e-3 * sqrt(square));
        assert_near(d.maximum[way], s, 1e-14);
    }
    assert_near(d.diagonal, sqrt(3), 1e-14);
    gvc_mesh_destroy(&cube);
    gvc_mesh_destroy(&shifted);
}

static void concentric_spheres_are_their_radii_apart(void **state) {
    (void)state;
    gvc_mesh *inner = make_sphere(60, 1), *outer = make_sphere(60, 1.1);
    gvc_distance d = measure(inner, outer, 0);
    for (int way = 0; way < 2; way++) {
        assert_near(d.mean[way], 0.1, 3e-4);
        assert_near(d.rms[way], 0.1, 3e-4);
        assert_near(d.maximum[way], 0.1, 3e-4);
    }
    gvc_distance none = measure(inner, inner, 5000);
    assert_near(none.maximum[0], 0, 1e-14);
    gvc_mesh_destroy(&inner);
    gvc_mesh_destroy(&outer);
}

/* The tip of a needle, which no sample meets, counts; a vertex that no face uses does not. */
static void maximum_sees_used_vertices_only(void **state) {
    (void)state;
    const double positions[24] = {0, 0, 0, 1,   0,   0, 1,   1,   0, 0,          1,   0,
                                  9, 9, 9, 0.5, 0.5, 3, 0.5, 0.5, 0, 0.5 + 1e-7, 0.5, 0};
    const uint32_t needle[9] = {0, 1, 2, 0, 2, 3, 5, 6, 7}, line[9] = {0, 1, 2, 0, 2, 3, 6, 6, 5};
    gvc_mesh *square = make_square(1, 0);
    gvc_mesh *with_needle = make(positions, 8, needle, 3);
    gvc_mesh *with_line = make(positions, 8, line, 3); /* no area, so no samples */
    gvc_distance d = measure(square, with_needle, 10);
    assert_near(d.mean[1], 0, 1e-12);
    assert_near(d.maximum[0], 0, 1e-12);
    assert_near(d.maximum[1], 3, 1e-12);
    assert_near(d.diagonal, sqrt(2), 1e-14);
    d = measure(with_line, square, 10);
    assert_near(d.mean[0], 0, 1e-12);
    assert_near(d.maximum[0], 3, 1e-12);
    assert_near(d.diagonal, sqrt(1 + 1 + 9), 1e-14);
    gvc_mesh_destroy(&square);
    gvc_mesh_destroy(&with_needle);
    gvc_mesh_destroy(&with_line);
}

static void distance_is_deterministic_with_default_samples(void **state) {
    (void)state;
    gvc_mesh *first = make_sphere(12, 1), *second = make_soup(300, 9);
    gvc_distance a = measure(first, second, 0), b = measure(first, second, 20000);
    gvc_distance back = measure(second, first, 0);
    assert_memory_equal(&a, &b, sizeof a);
    for (int way = 0; way < 2; way++) {
        assert_true(a.mean[way] == back.mean[1 - way]);
        assert_true(a.rms[way] == back.rms[1 - way]);
        assert_true(a.maximum[way] == back.maximum[1 - way]);
        assert_true(a.mean[way] <= a.rms[way] && a.rms[way] <= a.maximum[way]);
    }
    gvc_mesh_destroy(&first);
    gvc_mesh_destroy(&second);
}

static void distance_reports_bad_input(void **state) {
    (void)state;
    gvc_mesh *square = make_square(1, 0), *empty = make(NULL, 0, NULL, 0);
    gvc_distance d;
    gvc_error error;
    gvc_error_init(&error);
    assert_int_equal(gvc_mesh_distance(NULL, square, 0, &d, &error), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_mesh_distance(square, square, 0, NULL, &error), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_mesh_distance(square, empty, 0, &d, &error), GVC_ERROR_MESH);
    assert_int_equal(gvc_mesh_distance(empty, square, 0, &d, &error), GVC_ERROR_MESH);
    assert_int_equal(gvc_mesh_distance(square, square, SIZE_MAX / 2, &d, &error), GVC_ERROR_MEMORY);
    gvc_mesh_destroy(&square);
    gvc_mesh_destroy(&empty);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closest_matches_brute_force_on_a_soup),
        cmocka_unit_test(closest_matches_brute_force_on_a_sphere),
        cmocka_unit_test(closest_matches_brute_force_for_one_to_nine_faces),
        cmocka_unit_test(hierarchy_stays_shallow_on_spiteful_meshes),
        cmocka_unit_test(limit_is_inclusive_and_respected),
        cmocka_unit_test(normal_leaves_out_faces_that_look_away),
        cmocka_unit_test(no_faces_means_no_closest_point),
        cmocka_unit_test(samples_are_spread_by_area),
        cmocka_unit_test(samples_need_an_area),
        cmocka_unit_test(parallel_squares_are_their_offset_apart),
        cmocka_unit_test(directions_are_kept_apart),
        cmocka_unit_test(shifted_cube_matches_the_integrals),
        cmocka_unit_test(concentric_spheres_are_their_radii_apart),
        cmocka_unit_test(maximum_sees_used_vertices_only),
        cmocka_unit_test(distance_is_deterministic_with_default_samples),
        cmocka_unit_test(distance_reports_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
