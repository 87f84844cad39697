/* SPDX-License-Identifier: BSD-2-Clause */
/* libasj beside what else there is: time of detection and matching against detectors and matchers of OpenCV, in one run, on the
 * same images, with the same number of threads, in turn. */
#include "measure.h"
#include "views.h"

extern "C" {
#include "photograph.h"
}

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <getopt.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

const char help[] =
    "usage: peers [--threads N]... [--runs N] [--scale] [--quick] [FOLDER...]\n"
    "\n"
    "Times libasj and OpenCV's SIFT, ORB, AKAZE, LSD and brute-force matching, all with their defaults, on two views of the\n"
    "sample room (1052 x 780) and on the pairs of each folder (NAME/1.png, NAME/2.png), with 1 and 2 threads unless asked\n"
    "otherwise. All take turns, N times (15) after a turn that is not counted. --scale: photographs are made as large as\n"
    "1052 x 780. --quick: 2 turns, a small room.\n"
    "\n"
    "ms        median of wall time; least; cpu: median of the processor time of all threads, which other programs disturb less\n"
    "libasj /  its time divided by that one's, each of the three ways\n"
    "match     libasj: all junctions of the preset match, and 500 L-junctions of either image\n";

const int WIDTH = 1052, HEIGHT = 780;

struct settings {
    std::vector<int> threads;
    std::vector<std::string> folders;
    int runs = 15, width = WIDTH, height = HEIGHT;
    bool scale = false;
};

struct pair_of_images {
    std::string name;
    cv::Mat first, second; /* 8-bit grey */
};

struct contestant {
    std::string name, what;
    std::function<size_t()> run; /* returns how many it found */
    std::vector<double> wall, cpu;
    size_t found = 0;
};

[[noreturn]] void fail(const std::string &what)
{
    throw std::runtime_error(what);
}

/* --- images ----------------------------------------------------------------------------------------------------------------- */

cv::Mat room(int index, const settings &set)
{
    uint8_t *pixels = measure_room(index, set.width, set.height);
    if (!pixels)
        fail("cannot render the room");
    const cv::Mat copy = cv::Mat(set.height, set.width, CV_8UC1, pixels).clone();
    free(pixels);
    return copy;
}

cv::Mat read(const char *path, const settings &set)
{
    photograph p;
    if (photograph_read(path, &p) != 0)
        fail("cannot read a photograph");
    cv::Mat image = cv::Mat(p.height, p.width, CV_8UC1, p.pixels).clone();
    photograph_free(&p);
    const double factor = std::sqrt(double(WIDTH) * HEIGHT / (double(image.cols) * image.rows));
    if (set.scale) {
        cv::Mat scaled;
        cv::resize(image, scaled, cv::Size(), factor, factor, factor < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
        return scaled;
    }
    return image;
}

std::string folder_of(const std::string &path)
{
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : path.substr(0, slash);
}

void add_pairs(const settings &set, const std::string &folder, std::vector<pair_of_images> &pairs)
{
    path_list list;
    memset(&list, 0, sizeof list);
    if (path_list_add(&list, folder.c_str()) != 0)
        fail("no pairs of photographs");
    for (int32_t i = 0; i + 1 < list.count; i++) {
        const std::string place = folder_of(list.paths[i]);
        if (place != folder_of(list.paths[i + 1]))
            continue;
        const std::string name = place.substr(place.rfind('/') + 1);
        pairs.push_back({name, read(list.paths[i], set), read(list.paths[i + 1], set)});
        i++;
    }
    path_list_free(&list);
}

asj_image view_of(const cv::Mat &image)
{
    asj_image view = {image.data, ASJ_FORMAT_GRAY8, image.cols, image.rows, 0, 0};
    view.stride = (ptrdiff_t)image.step[0];
    return view;
}

/* --- libasj ----------------------------------------------------------------------------------------------------------------- */

struct library { /* a context, and what it has found in both images for matching */
    asj_context *context;
    benchmark_view all[2], some[2];

    library(const pair_of_images &pair, int threads) : context(measure_context(threads))
    {
        const asj_image images[2] = {view_of(pair.first), view_of(pair.second)};
        memset(all, 0, sizeof all);
        memset(some, 0, sizeof some);
        for (int i = 0; i < 2; i++) {
            if (!context || benchmark_view_make(context, &images[i], 0, 1, &all[i]) != 0 ||
                benchmark_view_make(context, &images[i], 500, 1 + (uint64_t)i, &some[i]) != 0)
                fail("libasj cannot prepare");
            benchmark_view_take(&all[i], SIZE_MAX, 20);
            benchmark_view_take(&some[i], 500, 20);
        }
    }

    ~library()
    {
        for (int i = 0; i < 2; i++) {
            benchmark_view_free(&all[i]);
            benchmark_view_free(&some[i]);
        }
        asj_context_free(&context);
    }

    library(const library &) = delete;
    library &operator=(const library &) = delete;

    size_t detect(const cv::Mat &image) const
    {
        const asj_image view = view_of(image);
        asj_detection *found = nullptr;
        if (asj_detect(context, &view, nullptr, &found) != ASJ_OK)
            fail(asj_context_message(context));
        const size_t count = found->junction_count;
        asj_detection_free(&found);
        return count;
    }

    size_t match(const benchmark_view views[2]) const
    {
        asj_match_result *found = nullptr;
        if (asj_match(context, &views[0].image, views[0].list, views[0].count, &views[1].image, views[1].list, views[1].count,
                      nullptr, &found) != ASJ_OK)
            fail(asj_context_message(context));
        const size_t count = found->match_count;
        asj_match_result_free(&found);
        return count;
    }
};

/* --- OpenCV ----------------------------------------------------------------------------------------------------------------- */

contestant describe_with(const std::string &name, const cv::Ptr<cv::Feature2D> &detector, const cv::Mat &image)
{
    return {name, "key points, described", [detector, image] {
        std::vector<cv::KeyPoint> points;
        cv::Mat descriptors;
        detector->detectAndCompute(image, cv::noArray(), points, descriptors);
        return points.size();
    }, {}, {}};
}

contestant detect_with_sift(const cv::Mat &image)
{
    const cv::Ptr<cv::SIFT> sift = cv::SIFT::create();
    return {"SIFT, detect", "key points", [sift, image] {
        std::vector<cv::KeyPoint> points;
        sift->detect(image, points);
        return points.size();
    }, {}, {}};
}

contestant detect_with_lsd(const cv::Mat &image)
{
    const cv::Ptr<cv::LineSegmentDetector> lsd = cv::createLineSegmentDetector();
    return {"LSD", "segments", [lsd, image] {
        std::vector<cv::Vec4f> lines;
        lsd->detect(image, lines);
        return lines.size();
    }, {}, {}};
}

contestant match_with(const std::string &name, const cv::Ptr<cv::Feature2D> &detector, int norm, const pair_of_images &pair)
{
    std::vector<cv::KeyPoint> points;
    cv::Mat one, two;
    detector->detectAndCompute(pair.first, cv::noArray(), points, one);
    detector->detectAndCompute(pair.second, cv::noArray(), points, two);
    char what[64];
    snprintf(what, sizeof what, "of %d, %d by ratio", one.rows, two.rows);
    return {name, what, [norm, one, two] {
        std::vector<std::vector<cv::DMatch>> best;
        size_t good = 0;
        if (one.rows > 0 && two.rows > 1)
            cv::BFMatcher(norm).knnMatch(one, two, best, 2);
        for (const std::vector<cv::DMatch> &two_best : best)
            good += two_best.size() == 2 && two_best[0].distance < 0.75f * two_best[1].distance;
        return good;
    }, {}, {}};
}

/* --- measuring -------------------------------------------------------------------------------------------------------------- */

double processor_ms()
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

/* The pause: threads of the one before may still be spinning for more work. */
void take_turn(contestant &c, bool counted)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const double cpu = processor_ms();
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    c.found = c.run();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    if (counted) {
        c.wall.push_back(wall.count());
        c.cpu.push_back(processor_ms() - cpu);
    }
}

double median(std::vector<double> values)
{
    return measure_median(values.data(), (int32_t)values.size());
}

double least(const std::vector<double> &values)
{
    return *std::min_element(values.begin(), values.end());
}

void print(const char *title, const std::vector<contestant> &all, size_t ours, const std::vector<size_t> &rows)
{
    printf("  %-22s %9s %9s %9s %8s  %27s\n", title, "ms", "least", "cpu", "found", "libasj / ms, least, cpu");
    for (const size_t i : rows) {
        const contestant &c = all[i], &us = all[ours];
        printf("  %-22s %9.2f %9.2f %9.2f %8zu", c.name.c_str(), median(c.wall), least(c.wall), median(c.cpu), c.found);
        if (i != ours)
            printf("  %8.2fx %8.2fx %8.2fx", median(us.wall) / median(c.wall), least(us.wall) / least(c.wall),
                   median(us.cpu) / median(c.cpu));
        else
            printf("  %27s", "");
        printf("  %s\n", c.what.c_str());
    }
}

void compare(const pair_of_images &pair, int threads, const settings &set)
{
    cv::setNumThreads(threads);
    const library asj(pair, threads);
    const cv::Mat &image = pair.first;
    char what[64];
    snprintf(what, sizeof what, "of %zu, %zu junctions", asj.all[0].count, asj.all[1].count);
    std::vector<contestant> all = {
        {"libasj", "junctions", [&asj, &image] { return asj.detect(image); }, {}, {}},
        describe_with("SIFT", cv::SIFT::create(), image),
        detect_with_sift(image),
        describe_with("ORB", cv::ORB::create(), image),
        describe_with("AKAZE", cv::AKAZE::create(), image),
        detect_with_lsd(image),
        {"libasj match", what, [&asj] { return asj.match(asj.all); }, {}, {}},
        match_with("SIFT brute force", cv::SIFT::create(), cv::NORM_L2, pair),
        match_with("ORB brute force", cv::ORB::create(), cv::NORM_HAMMING, pair),
        {"libasj match 500", "of 500, 500 L-junctions", [&asj] { return asj.match(asj.some); }, {}, {}},
    };
    for (int run = -1; run < set.runs; run++)
        for (contestant &c : all)
            take_turn(c, run >= 0);
    printf("%s, %d x %d, %d thread%s\n", pair.name.c_str(), image.cols, image.rows, threads, threads == 1 ? "" : "s");
    print("detection", all, 0, {0, 1, 2, 3, 4, 5});
    print("matching", all, 6, {6, 7, 8});
    print("500 L-junctions", all, 9, {9, 1, 2});
    printf("\n");
    fflush(stdout);
}

/* --- command line ----------------------------------------------------------------------------------------------------------- */

bool parse(int argc, char **argv, settings &set)
{
    static const struct option longs[] = {{"threads", 1, nullptr, 't'}, {"runs", 1, nullptr, 'r'}, {"scale", 0, nullptr, 's'},
                                          {"quick", 0, nullptr, 'q'}, {nullptr, 0, nullptr, 0}};
    int c;
    while ((c = getopt_long(argc, argv, "", longs, nullptr)) != -1) {
        int32_t value = 0;
        if (c == 't' && measure_number(optarg, 1, 256, &value) == 0) {
            set.threads.push_back(value);
        } else if (c == 'r' && measure_number(optarg, 1, 10000, &value) == 0) {
            set.runs = value;
        } else if (c == 's') {
            set.scale = true;
        } else if (c == 'q') {
            set.runs = 2;
            set.width = 320;
            set.height = 240;
        } else {
            return false;
        }
    }
    set.folders.assign(argv + optind, argv + argc);
    if (set.threads.empty())
        set.threads = {1, 2};
    return true;
}

void run(const settings &set)
{
    std::vector<pair_of_images> pairs = {{"sample room", room(0, set), room(1, set)}};
    for (const std::string &folder : set.folders)
        add_pairs(set, folder, pairs);
    printf("libasj %s, OpenCV %s, %d runs\n\n", asj_version_string(), CV_VERSION, set.runs);
    for (const pair_of_images &pair : pairs)
        for (const int threads : set.threads)
            compare(pair, threads, set);
}

} /* namespace */

int main(int argc, char **argv)
{
    settings set;
    if (!parse(argc, argv, set)) {
        fputs(help, stderr);
        return 2;
    }
    try {
        run(set);
    } catch (const std::exception &error) {
        fprintf(stderr, "peers: %s\n", error.what());
        return 1;
    }
    return 0;
}
