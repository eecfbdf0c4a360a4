/* replay LIBRARY < CALLS > CALLS: run recorded calls of entry points, and write what they leave.

   A call is the symbol of the entry point, its words with 0 for the address of each array, and the arrays, each with its place
   among the words and its number of bytes. */

#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct call { char symbol[112]; int64_t words, arrays; };
struct array { int64_t place, bytes; };

static void *take(size_t bytes)
{
    void *taken = aligned_alloc(64, (bytes / 64 + 1) * 64);
    if (!taken || fread(taken, 1, bytes, stdin) != bytes) exit(2);
    return taken;
}

int main(int count, char **arguments)
{
    struct call call;
    struct array arrays[64];
    void *library = dlopen(count == 2 ? arguments[1] : "", RTLD_NOW);
    while (library && fread(&call, sizeof call, 1, stdin) == 1) {
        void (*run)(int64_t *);
        void *function = dlsym(library, call.symbol);
        int64_t *words = take(8 * call.words);
        if (!function || call.arrays > 64) break;
        memcpy(&run, &function, sizeof run);
        for (int k = 0; k < call.arrays; k++) {
            if (fread(&arrays[k], sizeof arrays[k], 1, stdin) != 1) exit(2);
            words[arrays[k].place] = (int64_t)take(arrays[k].bytes);
        }
        run(words);
        void *kept[64];
        for (int k = 0; k < call.arrays; k++) {
            kept[k] = (void *)words[arrays[k].place];
            words[arrays[k].place] = 0;
        }
        fwrite(&call, sizeof call, 1, stdout);
        fwrite(words, 8, call.words, stdout);
        for (int k = 0; k < call.arrays; k++) {
            fwrite(&arrays[k], sizeof arrays[k], 1, stdout);
            fwrite(kept[k], 1, arrays[k].bytes, stdout);
            free(kept[k]);
        }
        free(words);
    }
    if (feof(stdin)) return 0;
    fprintf(stderr, "%s\n", dlerror());
    return 1;
}
