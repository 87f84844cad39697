/* SPDX-License-Identifier: BSD-2-Clause */
#include "unit_test.h"

#include "core/context.h"
#include "detect/gradient.h"
#include "room.h"

void unit_near(const char *what, double at, double also_at, double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s (%g, %g) is %.9g, expected %.9g within %g", what, at, also_at, value, expected, tolerance);
}

double unit_turn(double a, double b)
{
    return fabs(remainder(a - b, 2 * UNIT_PI));
}

void *unit_allocate(void *user, size_t size)
{
    unit_counter *counter = user;
    counter->calls++;
    if (counter->fail_at && (counter->calls == counter->fail_at || (counter->for_good && counter->calls > counter->fail_at)))
        return NULL;
    void *block = malloc(size);
    counter->live += block != NULL;
    return block;
}

void unit_release(void *user, void *block)
{
    unit_counter *counter = user;
    counter->live--;
    free(block);
}

asj_memory unit_memory(unit_counter *counter)
{
    return (asj_memory){.allocator = {unit_allocate, unit_release, counter}};
}

asj_context *unit_context(unit_counter *counter, int32_t threads)
{
    asj_context_options options;
    asj_context *context = NULL;
    memset(counter, 0, sizeof *counter);
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = threads;
    options.allocator = (asj_allocator){unit_allocate, unit_release, counter};
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_non_null(context);
    return context;
}

int32_t unit_count_question(void *user, int32_t stage, double done)
{
    (void)stage;
    (void)done;
    ++*(long *)user;
    return 0;
}

int unit_reached(unit_counter *counter)
{
    const int reached = counter->calls >= counter->fail_at;
    counter->fail_at = 0;
    return reached;
}

void unit_context_free(unit_counter *counter, asj_context **context)
{
    asj_context_free(context);
    assert_null(*context);
    assert_int_equal(counter->live, 0);
}

uint8_t *unit_picture(synth_scene *scene, double blur, double noise, uint64_t seed)
{
    uint8_t *pixels = synth_photograph(scene, blur, noise, seed);
    synth_scene_free(scene);
    assert_non_null(pixels);
    return pixels;
}

uint8_t *unit_room_picture(int32_t viewpoint, int32_t width, int32_t height)
{
    const synth_camera camera = synth_room_camera(viewpoint, width, height);
    synth_room room;
    synth_view view;
    assert_int_equal(synth_room_make(&room), 0);
    assert_int_equal(synth_view_make(&room, &camera, 4, &view), 0);
    uint8_t *pixels = synth_photograph(&view.scene, 0.9, 2, (uint64_t)viewpoint + 1);
    assert_non_null(pixels);
    synth_view_free(&view);
    synth_room_free(&room);
    return pixels;
}

asj_image unit_gray8(const uint8_t *pixels, int32_t width, int32_t height)
{
    return (asj_image){pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
}

void unit_frame(asj_context *context, const asj_image *image, const asj_detect_options *options, asj_frame *frame)
{
    asj_detect_options defaults;
    asj_detect_options_init(&defaults);
    memset(frame, 0, sizeof *frame);
    assert_int_equal(asj_frame_prepare(context, frame, image->width, image->height), ASJ_OK);
    assert_int_equal(asj_frame_load(context, frame, image, ASJ_PLANE_LUMA), ASJ_OK);
    assert_int_equal(asj_gradient(context, frame, options ? options : &defaults), ASJ_OK);
}

void unit_frame_of(asj_context *context, synth_scene *scene, double blur, double noise, const asj_detect_options *options,
                   asj_frame *frame)
{
    const int32_t width = scene->width, height = scene->height;
    uint8_t *pixels = unit_picture(scene, blur, noise, 7);
    const asj_image image = unit_gray8(pixels, width, height);
    unit_frame(context, &image, options, frame);
    free(pixels);
}

int unit_set_up_threads(void **state, int32_t threads)
{
    unit_fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (!f)
        return -1;
    f->context = unit_context(&f->counter, threads);
    asj_detect_options_init(&f->options);
    return 0;
}

int unit_set_up(void **state)
{
    return unit_set_up_threads(state, 1);
}

int unit_set_up_scene(void **state, synth_scene *scene, double blur, double noise)
{
    const int failed = unit_set_up(state);
    unit_fixture *f = *state;
    if (failed)
        synth_scene_free(scene);
    else
        unit_frame_of(f->context, scene, blur, noise, NULL, &f->frame);
    return failed;
}

void unit_nothing_left(const unit_counter *counter)
{
    if (counter->live == 0)
        return;
    print_error("%ld blocks of memory were not released\n", counter->live);
    exit(EXIT_FAILURE);
}

int unit_tear_down(void **state)
{
    unit_fixture *f = *state;
    asj_frame_free(&f->context->memory, &f->frame);
    asj_context_free(&f->context);
    unit_nothing_left(&f->counter);
    free(f);
    return 0;
}

void unit_half_plane(synth_scene *scene, int32_t size, synth_point through, double angle, double low, double high)
{
    const double far = 4.0 * size, c = cos(angle), s = sin(angle);
    const synth_point corners[4] = {{through.x - far * c, through.y - far * s},
                                    {through.x - far * c + far * s, through.y - far * s - far * c},
                                    {through.x + far * c + far * s, through.y + far * s - far * c},
                                    {through.x + far * c, through.y + far * s}};
    synth_scene_init(scene, size, size, low);
    synth_scene_add(scene, corners, 4, synth_flat(high), 0);
}

static double unit_plane(const asj_frame *frame, const int16_t *plane, int32_t x, int32_t y)
{
    if (x < 0 || y < 0 || x >= frame->width || y >= frame->height)
        return 0;
    return (double)plane[y * frame->stride + x] / ASJ_GRADIENT_ONE;
}

double unit_gx(const asj_frame *frame, int32_t x, int32_t y)
{
    return unit_plane(frame, frame->gradient_x, x, y);
}

double unit_gy(const asj_frame *frame, int32_t x, int32_t y)
{
    return unit_plane(frame, frame->gradient_y, x, y);
}

double unit_gamma(double gx, double gy, double alpha)
{
    const double phi = atan2(gy, gx) + UNIT_PI / 2;
    return hypot(gx, gy) * fmax(fabs(cos(phi - alpha)) - fabs(sin(phi - alpha)), 0);
}
