/* SPDX-License-Identifier: BSD-2-Clause */
/* The operating system where it is Windows. */
#include "platform.h"

#include <direct.h>
#include <signal.h>
#include <string.h>
#include <windows.h>

double cli_now_ms(void)
{
    LARGE_INTEGER now, frequency;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    return (double)now.QuadPart * 1e3 / (double)frequency.QuadPart;
}

/* Consoles since Windows 10 understand them once they are told to. */
int cli_is_terminal(void)
{
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode;
    return GetConsoleMode(console, &mode) && SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

void cli_catch_signals(void (*note)(int number))
{
    signal(SIGINT, note);
    signal(SIGTERM, note);
    signal(SIGBREAK, note);
}

/* Files are no small numbers that are used again. */
void cli_hold_streams(void)
{
}

int cli_output_is_closed(void)
{
    return 0;
}

int cli_make_one_folder(const char *path)
{
    return _mkdir(path);
}

int cli_identify(const char *path, cli_identity *identity)
{
    BY_HANDLE_FILE_INFORMATION facts;
    int found = 0;
    /* folders cannot be opened so, and nobody is kept from the file */
    const HANDLE file = CreateFileA(path, 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL, OPEN_EXISTING, 0, NULL);
    if (file == INVALID_HANDLE_VALUE)
        return 0;
    if (GetFileType(file) == FILE_TYPE_DISK && GetFileInformationByHandle(file, &facts)) {
        identity->device = facts.dwVolumeSerialNumber;
        identity->number = (uint64_t)facts.nFileIndexHigh << 32 | facts.nFileIndexLow;
        found = 1;
    }
    CloseHandle(file);
    return found;
}

int cli_is_special(const char *path)
{
    cli_identity identity;
    return GetFileAttributesA(path) != INVALID_FILE_ATTRIBUTES && !cli_identify(path, &identity);
}

int cli_is_folder(const char *path)
{
    const DWORD facts = GetFileAttributesA(path);
    return facts != INVALID_FILE_ATTRIBUTES && (facts & FILE_ATTRIBUTE_DIRECTORY) != 0;
}

int cli_is_separator(char c)
{
    return c == '/' || c == '\\' || c == ':';
}

const char *cli_base_name(const char *path)
{
    const char *end = path + strlen(path);
    while (end > path && !cli_is_separator(end[-1]))
        end--;
    return end;
}
