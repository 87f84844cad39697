/* SPDX-License-Identifier: BSD-2-Clause */
#include "opencv_shim.h"

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <mutex>
#include <new>
#include <unistd.h>

namespace {

/* While it lives, what the process writes to standard error goes into a pipe. A full pipe drops the rest and blocks nobody. */
class captured_stderr {
public:
    captured_stderr()
    {
        saved = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
        if (saved < 0 || pipe(ends) != 0) { /* closed, or no file descriptors left: nothing to be done */
            ends[0] = -1;
            return;
        }
        for (int end : ends) {
            fcntl(end, F_SETFD, FD_CLOEXEC);
            fcntl(end, F_SETFL, O_NONBLOCK);
        }
        std::fflush(stderr);
        dup2(ends[1], STDERR_FILENO);
    }

    /* Gives standard error back, and the beginning of what was written. */
    void finish(char *text, size_t size)
    {
        text[0] = '\0';
        if (ends[0] >= 0) {
            std::fflush(stderr);
            dup2(saved, STDERR_FILENO);
            close(ends[1]);
            ssize_t got = read(ends[0], text, size - 1);
            text[got > 0 ? got : 0] = '\0';
            close(ends[0]);
            ends[0] = -1;
        }
        if (saved >= 0)
            close(saved);
        saved = -1;
    }

    ~captured_stderr()
    {
        char rest[2];
        finish(rest, sizeof rest);
    }

    captured_stderr(const captured_stderr &) = delete;
    captured_stderr &operator=(const captured_stderr &) = delete;

private:
    int ends[2] = {-1, -1};
    int saved = -1;
};

/* OpenCV's own log is silent while it lives. */
class silent_log {
public:
    silent_log() : before(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
    ~silent_log() { cv::utils::logging::setLogLevel(before); }
    silent_log(const silent_log &) = delete;
    silent_log &operator=(const silent_log &) = delete;

private:
    cv::utils::logging::LogLevel before;
};

int32_t sample_of(int depth)
{
    switch (depth) {
    case CV_8U: return ASJ_OPENCV_U8;
    case CV_16U: return ASJ_OPENCV_U16;
    case CV_32F: return ASJ_OPENCV_F32;
    case CV_64F: return ASJ_OPENCV_F64;
    default: return ASJ_OPENCV_OTHER;
    }
}

cv::Mat decode(const unsigned char *bytes, size_t size, const char *path)
{
    const int flags = cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION;
    if (path)
        return cv::imread(path, flags);
    /* a view: imdecode() only reads it */
    const cv::Mat view(1, static_cast<int>(size), CV_8U, const_cast<unsigned char *>(bytes));
    return cv::imdecode(view, flags);
}

/* The line by which libjpeg tells that it made up pixels, or null. It tells the first fault only. Surplus bytes before the end
 * marker (0xd9) are no fault: telephones leave them there, and every pixel has been read before. Lines of other decoders (an
 * unknown tag of a TIFF file) are harmless. */
const char *damage_in(const char *complaint)
{
    const char *damage = std::strstr(complaint, "Corrupt JPEG data");
    if (damage && std::strstr(damage, "extraneous bytes before marker 0xd9"))
        return nullptr;
    return damage ? damage : std::strstr(complaint, "Premature end of JPEG");
}

/* The cause in OpenCV's "imdecode_(''): can't read data: OpenCV(4.6.0) ./modules/...: error: (-2:Unspecified error) CAUSE in
 * function 'x'", or the first line of anything else. */
void copy_cause(char *cause, size_t cause_size, const char *complaint)
{
    const char *start = std::strstr(complaint, " error: (");
    start = start ? std::strchr(start, ')') : nullptr;
    start = start ? start + 1 : complaint;
    while (*start == ' ')
        start++;
    const char *end = std::strstr(start, " in function");
    size_t length = end ? static_cast<size_t>(end - start) : std::strcspn(start, "\n");
    std::snprintf(cause, cause_size, "%.*s", static_cast<int>(length < 200 ? length : 200), start);
}

} // namespace

asj_status asj_opencv_decode(const unsigned char *bytes, size_t size, const char *path, asj_opencv_image *image,
                             char *cause, size_t cause_size)
{
    static std::mutex one_at_a_time; /* standard error and OpenCV's log level belong to the whole process */
    char complaint[1024] = "";
    cause[0] = '\0';
    try {
        const std::lock_guard<std::mutex> lock(one_at_a_time);
        const silent_log quiet;
        captured_stderr capture;
        cv::Mat matrix = decode(bytes, size, path);
        capture.finish(complaint, sizeof complaint);
        const char *damage = damage_in(complaint);
        if (matrix.empty() || damage) {
            copy_cause(cause, cause_size, damage ? damage : complaint);
            return ASJ_ERROR_FORMAT;
        }
        image->matrix = new cv::Mat(matrix);
        image->pixels = matrix.data;
        image->stride = matrix.step;
        image->width = matrix.cols;
        image->height = matrix.rows;
        image->channels = matrix.channels();
        image->sample = sample_of(matrix.depth());
        return ASJ_OK;
    } catch (const std::bad_alloc &) {
        return ASJ_ERROR_MEMORY;
    } catch (const cv::Exception &error) {
        std::snprintf(cause, cause_size, "%s", error.err.c_str());
        return error.code == cv::Error::StsNoMem ? ASJ_ERROR_MEMORY : ASJ_ERROR_FORMAT;
    } catch (const std::exception &error) {
        std::snprintf(cause, cause_size, "%s", error.what());
        return ASJ_ERROR_FORMAT;
    } catch (...) {
        return ASJ_ERROR_FORMAT;
    }
}

void asj_opencv_release(asj_opencv_image *image)
{
    delete static_cast<cv::Mat *>(image->matrix);
    image->matrix = nullptr;
}
