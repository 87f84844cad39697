/* SPDX-License-Identifier: BSD-2-Clause */
/* RFC 8259, without recursion: which of the open brackets are objects is one bit each. */
#include "json_skip.h"

#include <string.h>

enum { MOST_DEPTH = 1024 };

typedef struct skipper {
    const char *at, *end;
    unsigned char is_object[MOST_DEPTH / 8];
    int depth;
} skipper;

static char look(const skipper *s)
{
    return s->at < s->end ? *s->at : '\0';
}

static void skip_space(skipper *s)
{
    while (look(s) && strchr(" \t\r\n", look(s)))
        s->at++;
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int skip_hex(skipper *s)
{
    int i;
    for (i = 0; i < 4; i++, s->at++)
        if (!look(s) || !strchr("0123456789abcdefABCDEF", look(s)))
            return 0;
    return 1;
}

static int skip_string(skipper *s)
{
    for (s->at++; s->at < s->end && (unsigned char)*s->at >= 32; s->at++) {
        if (*s->at == '"') {
            s->at++;
            return 1;
        }
        if (*s->at != '\\')
            continue;
        s->at++;
        if (look(s) == 'u') {
            s->at++;
            if (!skip_hex(s))
                return 0;
            s->at--;
        } else if (!look(s) || !strchr("\"\\/bfnrt", look(s))) {
            return 0;
        }
    }
    return 0;
}

static int skip_digits(skipper *s)
{
    const char *first = s->at;
    while (is_digit(look(s)))
        s->at++;
    return s->at > first;
}

static int skip_number(skipper *s)
{
    if (look(s) == '-')
        s->at++;
    if (look(s) == '0')
        s->at++;
    else if (!skip_digits(s))
        return 0;
    if (look(s) == '.') {
        s->at++;
        if (!skip_digits(s))
            return 0;
    }
    if (look(s) == 'e' || look(s) == 'E') {
        s->at++;
        if (look(s) == '+' || look(s) == '-')
            s->at++;
        return skip_digits(s);
    }
    return 1;
}

static int skip_word(skipper *s, const char *word)
{
    size_t length = strlen(word);
    if ((size_t)(s->end - s->at) < length || memcmp(s->at, word, length))
        return 0;
    s->at += length;
    return 1;
}

/* A value without brackets. */
static int skip_plain(skipper *s)
{
    switch (look(s)) {
    case '"': return skip_string(s);
    case 't': return skip_word(s, "true");
    case 'f': return skip_word(s, "false");
    case 'n': return skip_word(s, "null");
    default: return skip_number(s);
    }
}

static int in_object(const skipper *s)
{
    return s->is_object[(s->depth - 1) / 8] >> (s->depth - 1) % 8 & 1;
}

static int open_bracket(skipper *s)
{
    if (s->depth == MOST_DEPTH)
        return 0;
    if (look(s) == '{')
        s->is_object[s->depth / 8] = (unsigned char)(s->is_object[s->depth / 8] | 1 << s->depth % 8);
    else
        s->is_object[s->depth / 8] = (unsigned char)(s->is_object[s->depth / 8] & ~(1 << s->depth % 8));
    s->depth++;
    s->at++;
    return 1;
}

/* In an object the key of the next value. */
static int skip_key(skipper *s)
{
    skip_space(s);
    if (!s->depth || !in_object(s))
        return 1;
    if (look(s) != '"' || !skip_string(s))
        return 0;
    skip_space(s);
    if (look(s) != ':')
        return 0;
    s->at++;
    skip_space(s);
    return 1;
}

/* Behind a value: closing brackets, and a comma when something follows. 1 = the outermost value has ended, 0 = another one follows,
 * -1 = damaged. `is_empty`: a bracket has just been opened. */
static int skip_behind(skipper *s, int is_empty)
{
    for (;; is_empty = 0) {
        if (!s->depth)
            return 1;
        skip_space(s);
        if (look(s) == (in_object(s) ? '}' : ']')) {
            s->at++;
            s->depth--;
            continue;
        }
        if (is_empty)
            return 0;
        if (look(s) != ',')
            return -1;
        s->at++;
        return 0;
    }
}

const char *asj_json_skip(const char *at, const char *end, const char **stop)
{
    skipper s;
    int ended = 0;

    s.at = at;
    s.end = end;
    s.depth = 0;
    while (!ended) {
        int opens, good = skip_key(&s);
        opens = good && (look(&s) == '{' || look(&s) == '[');
        if (good)
            good = opens ? open_bracket(&s) : skip_plain(&s);
        ended = good ? skip_behind(&s, opens) : -1;
    }
    *stop = s.at;
    return ended > 0 ? s.at : NULL;
}
