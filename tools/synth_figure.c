/* SPDX-License-Identifier: MIT */
/** @file synth_figure.c  The moving figure as an implicit surface. */
#include "synth_figure.h"

#define TAU 6.283185307179586
/* Width of the rounding where limbs meet. */
#define BLEND 0.016
/* Folds of cloth: amplitude, and wave numbers along and around a limb. */
#define FOLD 0.0012

double figure_random(uint64_t seed, uint64_t stream, uint64_t index) {
    uint64_t z = seed * UINT64_C(0xd1342543de82ef95) + stream * UINT64_C(0x2545f4914f6cdd1d) +
                 (index + 1) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

/* -------------------------------------------------------------------------------------- motion */

/* A swing about `mean`: `turns` per beat with phase and amplitude that vary with the seed. */
typedef struct dance {
    double beat; /* time in turns of the main rhythm */
    uint64_t seed;
    uint64_t used; /* swings asked for so far, so that each has its own variation */
} dance;

static double swing(dance *d, double mean, double amplitude, double turns, double phase) {
    uint64_t k = d->used++;
    double strength = 0.85 + 0.3 * figure_random(d->seed, 1, k);
    double shift = 0.08 * (figure_random(d->seed, 2, k) - 0.5);
    /* A second, slower wave keeps the dance from repeating. */
    double slow = sin(TAU * (0.37 * d->beat + figure_random(d->seed, 3, k)));
    return mean + strength * amplitude * (0.85 + 0.15 * slow) *
                      sin(TAU * (turns * d->beat + phase + shift));
}

static void add_bone(figure *f, vec3 a, vec3 b, double ra, double rb) {
    f->bone[f->bone_count++] = (figure_bone){{a, b}, {ra, rb}};
}

/* The point `v` in the axes of `axes` from `origin`. */
static vec3 at(vec3 origin, const frame3 *axes, double x, double y, double z) {
    return vec3_add(origin, frame3_apply(axes, vec3_make(x, y, z)));
}

static void pose_torso(figure *f, dance *d, vec3 pelvis, const frame3 *hips, frame3 *chest_axes,
                       vec3 *chest) {
    frame3 axes = frame3_turn_y(*hips, swing(d, 0, 0.35, 1, 0.35));
    axes = frame3_turn_x(axes, swing(d, 0.08, 0.10, 2, 0.1));
    axes = frame3_turn_z(axes, swing(d, 0, 0.12, 1, 0.6));
    *chest_axes = axes;
    *chest = at(pelvis, &axes, 0, 0.36, 0);
    vec3 neck = at(pelvis, &axes, 0, 0.51, 0);
    frame3 face = frame3_turn_y(axes, swing(d, 0, 0.4, 0.5, 0));
    face = frame3_turn_x(face, swing(d, -0.05, 0.12, 2, 0.3));
    vec3 head = at(neck, &face, 0, 0.16, 0.02);
    add_bone(f, at(pelvis, hips, -0.07, 0, 0), at(pelvis, hips, 0.07, 0, 0), 0.105, 0.105);
    add_bone(f, pelvis, *chest, 0.105, 0.115);
    add_bone(f, at(*chest, &axes, -0.10, 0.02, 0), at(*chest, &axes, 0.10, 0.02, 0), 0.085, 0.085);
    add_bone(f, *chest, neck, 0.075, 0.052);
    add_bone(f, neck, head, 0.050, 0.075);
    add_bone(f, head, at(head, &face, 0, 0.055, 0.005), 0.090, 0.092);
    add_bone(f, at(head, &face, 0, -0.005, 0.075), at(head, &face, 0, -0.03, 0.085), 0.018, 0.022);
}

/* `side` is -1 or 1; the arm hangs along -y of its axes, raised sideways and swung. Returns the
 * hand and its direction. */
static void pose_arm(figure *f, dance *d, double side, vec3 chest, const frame3 *chest_axes,
                     vec3 *hand, vec3 *direction) {
    double phase = side > 0 ? 0.0 : 0.37;
    vec3 shoulder = at(chest, chest_axes, side * 0.175, 0.055, 0);
    frame3 upper = frame3_turn_z(*chest_axes, side * swing(d, 1.05, 0.45, 1, phase));
    upper = frame3_turn_x(upper, swing(d, -0.15, 0.40, 1, phase + 0.25));
    vec3 elbow = at(shoulder, &upper, 0, -0.29, 0);
    /* The elbow bends forward (-x turns the hanging arm to the front). */
    frame3 fore = frame3_turn_x(upper, -swing(d, 0.75, 0.45, 1, phase + 0.55));
    vec3 wrist = at(elbow, &fore, 0, -0.25, 0);
    frame3 palm = frame3_turn_x(fore, swing(d, 0, 0.25, 2, phase));
    *hand = at(wrist, &palm, 0, -0.11, 0);
    *direction = vec3_scale(palm.y, -1);
    add_bone(f, shoulder, elbow, 0.058, 0.046);
    add_bone(f, elbow, wrist, 0.045, 0.032);
    add_bone(f, wrist, *hand, 0.033, 0.038);
}

static void pose_leg(figure *f, dance *d, double side, vec3 pelvis, const frame3 *hips) {
    double phase = side > 0 ? 0.0 : 0.5;
    vec3 hip = at(pelvis, hips, side * 0.10, -0.05, 0);
    frame3 thigh = frame3_turn_z(*hips, side * swing(d, 0.20, 0.04, 1, phase));
    thigh = frame3_turn_x(thigh, -swing(d, 0.12, 0.38, 1, phase));
    vec3 knee = at(hip, &thigh, 0, -0.41, 0);
    frame3 shin = frame3_turn_x(thigh, swing(d, 0.42, 0.30, 1, phase - 0.2));
    vec3 ankle = at(knee, &shin, 0, -0.41, 0);
    frame3 foot = frame3_turn_x(shin, swing(d, -0.2, 0.12, 1, phase));
    add_bone(f, hip, knee, 0.082, 0.058);
    add_bone(f, knee, ankle, 0.056, 0.042);
    add_bone(f, at(ankle, &foot, 0, -0.01, -0.02), at(ankle, &foot, 0, -0.035, 0.165), 0.045,
             0.034);
}

/* Rings that touch the figure in one place each: on the back, in both hands, on the head. */
static void pose_rings(figure *f, unsigned rings, vec3 chest, const frame3 *chest_axes,
                       const vec3 hand[2], const vec3 direction[2]) {
    const figure_bone *skull = &f->bone[5];
    vec3 up = vec3_unit(vec3_sub(skull->end[1], skull->end[0]));
    const figure_ring all[FIGURE_MAX_RINGS] = {
        {at(chest, chest_axes, 0, -0.04, -0.150), chest_axes->x, 0.085, 0.030},
        {vec3_add(hand[1], vec3_scale(direction[1], 0.115)),
         vec3_unit(vec3_cross(direction[1], chest_axes->x)), 0.100, 0.026},
        {vec3_add(hand[0], vec3_scale(direction[0], 0.115)),
         vec3_unit(vec3_cross(direction[0], chest_axes->x)), 0.100, 0.026},
        {vec3_add(skull->end[1], vec3_scale(up, 0.150)), chest_axes->z, 0.075, 0.026},
    };
    for (unsigned i = 0; i < rings && i < FIGURE_MAX_RINGS; i++) f->ring[f->ring_count++] = all[i];
}

void figure_pose(figure *f, double seconds, unsigned rings, uint64_t seed) {
    f->bone_count = f->ring_count = 0;
    dance d = {.beat = seconds / 2.1 + figure_random(seed, 4, 0), .seed = seed};
    frame3 hips = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    vec3 pelvis = vec3_make(swing(&d, 0, 0.06, 1, 0.25), swing(&d, 0.93, 0.025, 2, 0.1),
                            swing(&d, 0, 0.05, 0.5, 0.4));
    hips = frame3_turn_y(hips, swing(&d, 0, 0.35, 0.5, 0.2));
    hips = frame3_turn_z(hips, swing(&d, 0, 0.07, 1, 0));
    frame3 chest_axes;
    vec3 chest, hand[2], direction[2];
    pose_torso(f, &d, pelvis, &hips, &chest_axes, &chest);
    for (int i = 0; i < 2; i++) {
        double side = i ? 1 : -1;
        pose_arm(f, &d, side, chest, &chest_axes, &hand[i], &direction[i]);
        pose_leg(f, &d, side, pelvis, &hips);
    }
    pose_rings(f, rings, chest, &chest_axes, hand, direction);
}

/* ------------------------------------------------------------------------------------- surface */

/* Distance from the bare cone; `*along` gets the place along it in metres. */
static double bone_value(const figure_bone *bone, vec3 point, double *along) {
    vec3 axis = vec3_sub(bone->end[1], bone->end[0]), from = vec3_sub(point, bone->end[0]);
    double length = vec3_length(axis), t = vec3_dot(from, axis) / (length * length);
    double clamped = t < 0 ? 0 : t > 1 ? 1 : t;
    double radius = bone->radius[0] + (bone->radius[1] - bone->radius[0]) * clamped;
    *along = t * length;
    return vec3_length(vec3_sub(from, vec3_scale(axis, clamped))) - radius;
}

static double fold(unsigned bone, double along) {
    return FOLD * (sin(62 * along + 1.7 * bone) + 0.6 * sin(31 * along + bone));
}

static double ring_value(const figure_ring *ring, vec3 point) {
    vec3 from = vec3_sub(point, ring->centre);
    double height = vec3_dot(from, ring->axis);
    double reach = vec3_length(vec3_sub(from, vec3_scale(ring->axis, height))) - ring->radius;
    return sqrt(reach * reach + height * height) - ring->thickness;
}

/* Smooth union: -BLEND * log(sum exp(-value / BLEND)), computed from the least value; what is far
 * above that does not count, and gets no folds either. */
double figure_value(const figure *f, vec3 point) {
    double value[FIGURE_MAX_BONES + FIGURE_MAX_RINGS], along[FIGURE_MAX_BONES], least = INFINITY;
    unsigned bones = f->bone_count, count = bones + f->ring_count;
    for (unsigned i = 0; i < count; i++) {
        value[i] = i < bones ? bone_value(&f->bone[i], point, &along[i])
                             : ring_value(&f->ring[i - bones], point);
        least = value[i] < least ? value[i] : least;
    }
    double sum = 0;
    for (unsigned i = 0; i < count; i++) {
        double above = (value[i] - least) / BLEND;
        if (above < 25) sum += exp((i < bones ? fold(i, along[i]) / BLEND : 0) - above);
    }
    return least - BLEND * log(sum);
}

static vec3 gradient(const figure *f, vec3 p) {
    const double e = 1e-5;
    return vec3_make(
        (figure_value(f, (vec3){p.x + e, p.y, p.z}) - figure_value(f, (vec3){p.x - e, p.y, p.z})) /
            (2 * e),
        (figure_value(f, (vec3){p.x, p.y + e, p.z}) - figure_value(f, (vec3){p.x, p.y - e, p.z})) /
            (2 * e),
        (figure_value(f, (vec3){p.x, p.y, p.z + e}) - figure_value(f, (vec3){p.x, p.y, p.z - e})) /
            (2 * e));
}

vec3 figure_project(const figure *f, vec3 point) {
    for (int i = 0; i < 3; i++) { /* Newton's method along the gradient */
        double value = figure_value(f, point);
        if (fabs(value) < 1e-7) break;
        vec3 g = gradient(f, point);
        double square = vec3_dot(g, g);
        if (square < 0.2) square = 0.2; /* near the medial axis the step would be too long */
        point = vec3_sub(point, vec3_scale(g, value / square));
    }
    return point;
}

static void widen(vec3 *minimum, vec3 *maximum, vec3 p, double radius) {
    const vec3 low = vec3_sub(p, vec3_make(radius, radius, radius));
    const vec3 high = vec3_add(p, vec3_make(radius, radius, radius));
    *minimum = vec3_make(fmin(minimum->x, low.x), fmin(minimum->y, low.y), fmin(minimum->z, low.z));
    *maximum =
        vec3_make(fmax(maximum->x, high.x), fmax(maximum->y, high.y), fmax(maximum->z, high.z));
}

void figure_bounds(const figure *f, const frame3 *axes, vec3 *minimum, vec3 *maximum) {
    const double room = 4 * BLEND;
    *minimum = vec3_make(INFINITY, INFINITY, INFINITY);
    *maximum = vec3_make(-INFINITY, -INFINITY, -INFINITY);
    for (unsigned i = 0; i < f->bone_count; i++) {
        for (unsigned k = 0; k < 2; k++) {
            widen(minimum, maximum, frame3_coordinates(axes, f->bone[i].end[k]),
                  f->bone[i].radius[k] + room);
        }
    }
    for (unsigned i = 0; i < f->ring_count; i++) {
        widen(minimum, maximum, frame3_coordinates(axes, f->ring[i].centre),
              f->ring[i].radius + f->ring[i].thickness + room);
    }
}
