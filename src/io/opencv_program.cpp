/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-io-opencv PIXELS: decodes the image file on standard input with OpenCV and writes the pixels to standard output, for
 * libasj-io (decoder_process.c) and nobody else. The only C++ of the project. What is wrong with a file is told by an answer that
 * does not come. It limits its own memory to what an image of PIXELS needs, and its own time. */
#include "decoder_answer.h"
#include "shared/pixels.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <vector>

namespace {

#ifdef ASJ_ADDRESS_SANITIZER
const bool limits_memory = false; /* its shadow memory would not fit */
#else
const bool limits_memory = true;
#endif

void limit(int resource, rlim_t most)
{
    const struct rlimit both = {most, most};
    setrlimit(static_cast<decltype(RLIMIT_CPU)>(resource), &both);
}

/* One channel of colours that are all gray. */
cv::Mat gray_where_it_is(const cv::Mat &matrix)
{
    cv::Mat gray;
    if (matrix.type() != CV_8UC3)
        return matrix;
    for (int y = 0; y < matrix.rows; y++)
        for (int x = 0; x < matrix.cols; x++) {
            const cv::Vec3b bgr = matrix.at<cv::Vec3b>(y, x);
            if (bgr[0] != bgr[1] || bgr[1] != bgr[2])
                return matrix;
        }
    cv::extractChannel(matrix, gray, 0);
    return gray;
}

/* In memory where the system has that: folders for temporary files may be full, or not writable. */
std::FILE *nameless_file()
{
#ifdef MFD_CLOEXEC
    const int descriptor = memfd_create("image", 0);
    if (descriptor >= 0)
        return fdopen(descriptor, "w+b");
#endif
    return std::tmpfile();
}

/* OpenCV decodes BMP from memory, the others from a named file only: here one that has no name but this. Of a gray Sun raster file
 * without a colour map it makes zeros when it may answer in gray (4.6), so it must answer in colour there. */
cv::Mat decode(const std::vector<unsigned char> &bytes)
{
    const int flags = cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION;
    if (bytes.size() > 2 && bytes[0] == 'B')
        return cv::imdecode(bytes, flags);
    std::FILE *file = nameless_file();
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0)
        return cv::Mat();
    const std::string name = "/dev/fd/" + std::to_string(fileno(file));
    const bool is_sun_raster = bytes.size() > 4 && bytes[0] == 0x59 && bytes[1] == 0xa6;
    return is_sun_raster ? gray_where_it_is(cv::imread(name, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION))
                         : cv::imread(name, flags);
}

std::vector<unsigned char> read_input()
{
    std::vector<unsigned char> bytes;
    unsigned char block[65536];
    for (size_t got; (got = std::fread(block, 1, sizeof block, stdin)) > 0;)
        bytes.insert(bytes.end(), block, block + got);
    return bytes;
}

/* Colour in floats becomes luma. */
cv::Mat luma_of(const cv::Mat &matrix)
{
    cv::Mat gray(matrix.rows, matrix.cols, CV_32FC1);
    for (int y = 0; y < matrix.rows; y++)
        for (int x = 0; x < matrix.cols; x++) {
            const cv::Vec3f bgr = matrix.at<cv::Vec3f>(y, x);
            gray.at<float>(y, x) = asj_luma_float(bgr[2], bgr[1], bgr[0]);
        }
    return gray;
}

bool write_answer(const cv::Mat &decoded)
{
    const cv::Mat matrix = decoded.type() == CV_32FC3 ? luma_of(decoded) : decoded;
    asj_decoder_answer answer = {ASJ_DECODER_MAGIC, 0, static_cast<uint64_t>(matrix.cols), static_cast<uint64_t>(matrix.rows)};
    switch (matrix.type()) {
    case CV_8UC1: answer.samples = ASJ_DECODER_GRAY8; break;
    case CV_8UC3: answer.samples = ASJ_DECODER_BGR8; break;
    case CV_32FC1: answer.samples = ASJ_DECODER_GRAY_FLOAT; break;
    default: return false;
    }
    bool good = std::fwrite(&answer, sizeof answer, 1, stdout) == 1;
    for (int y = 0; y < matrix.rows && good; y++)
        good = std::fwrite(matrix.ptr(y), matrix.elemSize(), static_cast<size_t>(matrix.cols), stdout) ==
               static_cast<size_t>(matrix.cols);
    return good && std::fflush(stdout) == 0;
}

} // namespace

int main(int count, char **arguments)
{
    const unsigned long long pixels = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 0;
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, 10 + static_cast<rlim_t>(pixels / 10000000));
    try {
        const std::vector<unsigned char> bytes = read_input();
        if (limits_memory)
            limit(RLIMIT_DATA, (static_cast<rlim_t>(256) << 20) + 4 * bytes.size() + 48 * pixels);
        const cv::Mat matrix = decode(bytes);
        return !matrix.empty() && write_answer(matrix) ? 0 : 1;
    } catch (const std::exception &) {
        return 1;
    }
}
