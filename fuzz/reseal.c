/* SPDX-License-Identifier: MIT */
/** @file reseal.c  Recomputes every checksum of a file. */
#include "reseal.h"

#include "box_list.h"

#include "base/digest.h"
#include "container/iso.h"

#include <string.h>

#define MAX_TRAFS 4u

/* gcrc of the bytes from `begin` on, if one ends at `end`. */
static void seal(uint8_t *data, size_t begin, size_t end) {
    if (end - begin < GVC_GCRC_SIZE) return;
    uint8_t *gcrc = data + end - GVC_GCRC_SIZE;
    if (bytes_get_u32(gcrc) != GVC_GCRC_SIZE || bytes_get_u32(gcrc + 4) != GVC_BOX_GCRC) return;
    bytes_put_u32(gcrc + 12, gvc_crc32(0, data + begin, end - begin - 4));
}

/* ------------------------------------------------------------------------------------- fragments
 */

typedef struct run {
    uint8_t *offset, *sizes, *crc; /* data_offset and the first size in trun; the first of gcks */
    uint32_t count, default_size;
    size_t stride; /* from size to size; 0: all have default_size */
} run;

/* Where the size of the first sample stands, if the boxes hold as many as they say. */
static int find_run(uint8_t *data, const listed_box *tfhd, const listed_box *trun,
                    const listed_box *gcks, run *r) {
    if (trun->size < trun->header + 12u || gcks->size < gcks->header + 4u) return 0;
    uint8_t *at = data + trun->offset + trun->header;
    uint32_t flags = bytes_get_u32(at) & 0xffffff, fields = 0;
    *r = (run){.count = bytes_get_u32(at + 4), .offset = at + 8};
    if (!(flags & GVC_TRUN_DATA_OFFSET)) return 0;
    at += flags & GVC_TRUN_FIRST_FLAGS ? 16 : 12;
    for (uint32_t bit = GVC_TRUN_DURATION; bit <= GVC_TRUN_COMPOSITION; bit <<= 1) {
        fields += flags & bit ? 4 : 0;
    }
    r->sizes = at + (flags & GVC_TRUN_DURATION ? 4 : 0);
    if (flags & GVC_TRUN_SIZE) r->stride = fields;
    size_t left = trun->offset + trun->size - (size_t)(at - data);
    if ((size_t)(at - data) > trun->offset + trun->size || (uint64_t)r->count * fields > left ||
        r->count > (gcks->size - gcks->header - 4) / 4) {
        return 0;
    }
    if (tfhd && !r->stride && tfhd->size >= tfhd->header + 12u) {
        uint8_t *head = data + tfhd->offset + tfhd->header;
        uint32_t said = bytes_get_u32(head);
        size_t skip =
            8 + (said & GVC_TFHD_DESCRIPTION ? 4 : 0) + (said & GVC_TFHD_DURATION ? 4 : 0);
        if (said & GVC_TFHD_SIZE && tfhd->size - tfhd->header >= skip + 4) {
            r->default_size = bytes_get_u32(head + skip);
        }
    }
    r->crc = data + gcks->offset + gcks->header + 4;
    return 1;
}

/* Samples of `r` begin at `place` of the file; returns where they end. */
static size_t seal_samples(const uint8_t *data, size_t size, size_t place, const run *r) {
    for (uint32_t i = 0; i < r->count; i++) {
        size_t bytes = r->stride ? bytes_get_u32(r->sizes + i * r->stride) : r->default_size;
        if (place > size || bytes > size - place) return size;
        bytes_put_u32(r->crc + 4 * (size_t)i, gvc_crc32(0, data + place, bytes));
        place += bytes;
    }
    return place;
}

static void reseal_moof(uint8_t *data, size_t size, const box_list *list, size_t moof) {
    run runs[MAX_TRAFS];
    size_t count = 0;
    const listed_box *head = &list->box[moof], *traf = NULL;
    size_t after = moof;
    while (count < MAX_TRAFS && (traf = box_list_child(list, moof, GVC_BOX_TRAF, after))) {
        after = (size_t)(traf - list->box);
        const listed_box *tfhd = box_list_child(list, after, GVC_BOX_TFHD, NO_PARENT);
        const listed_box *trun = box_list_child(list, after, GVC_BOX_TRUN, NO_PARENT);
        const listed_box *gcks = box_list_child(list, after, GVC_BOX_GCKS, NO_PARENT);
        if (trun && gcks && find_run(data, tfhd, trun, gcks, &runs[count])) count++;
    }
    const listed_box *mdat = head->parent == NO_PARENT && moof + 1 < list->count
                                 ? &list->box[moof + 1] /* the next of the same level */
                                 : NULL;
    size_t header = mdat && mdat->type == GVC_BOX_MDAT ? mdat->header : 8;
    size_t place = head->offset + head->size + header;
    /* The runs lie in the order of their offsets. */
    for (size_t done = 0; done < count; done++) {
        size_t next = done;
        for (size_t i = done + 1; i < count; i++) {
            if (bytes_get_u32(runs[i].offset) < bytes_get_u32(runs[next].offset)) next = i;
        }
        run r = runs[next];
        runs[next] = runs[done];
        runs[done] = r;
    }
    for (size_t i = 0; i < count; i++) {
        bytes_put_u32(runs[i].offset, (uint32_t)(place - head->offset));
        place = seal_samples(data, size, place, &runs[i]);
    }
    seal(data, head->offset, head->offset + head->size);
}

/* ----------------------------------------------------------------------------------------- index
 */

static void reseal_places(uint8_t *data, const box_list *list, const listed_box *tfra) {
    enum { HEAD = 16 };
    if (tfra->size < tfra->header + (size_t)HEAD) return;
    uint8_t *at = data + tfra->offset + tfra->header;
    size_t width = at[0] == 1 ? 8 : 4, sizes = bytes_get_u32(at + 8);
    size_t stride = 2 * width + (sizes >> 4 & 3) + (sizes >> 2 & 3) + (sizes & 3) + 3;
    size_t left = tfra->size - tfra->header - HEAD;
    at += HEAD + width;
    for (size_t i = 0; i < list->count && left >= stride; i++) {
        if (list->box[i].type != GVC_BOX_MOOF || list->box[i].parent != NO_PARENT) continue;
        if (width == 8) bytes_put_u32(at, (uint32_t)((uint64_t)list->box[i].offset >> 32));
        bytes_put_u32(at + width - 4, (uint32_t)list->box[i].offset);
        at += stride;
        left -= stride;
    }
}

static void reseal_index(uint8_t *data, const box_list *list, size_t index) {
    const listed_box *mfra = &list->box[index];
    const listed_box *tfra = box_list_child(list, index, GVC_BOX_TFRA, index);
    if (tfra) reseal_places(data, list, tfra);
    size_t end = mfra->offset + mfra->size;
    if (mfra->size < mfra->header + GVC_GDIG_SIZE + GVC_GCRC_SIZE + GVC_MFRO_SIZE) return;
    uint8_t *mfro = data + end - GVC_MFRO_SIZE;
    uint8_t *gdig = mfro - GVC_GCRC_SIZE - GVC_GDIG_SIZE;
    if (bytes_get_u32(mfro + 4) == GVC_BOX_MFRO) bytes_put_u32(mfro + 12, (uint32_t)mfra->size);
    if (bytes_get_u32(gdig + 4) == GVC_BOX_GDIG) {
        gvc_sha256 *digest = gvc_sha256_begin();
        if (!digest) return;
        gvc_sha256_update(digest, data, (size_t)(gdig + 12 - data));
        gvc_sha256_end(digest, gdig + 12);
    }
    seal(data, mfra->offset, end - GVC_MFRO_SIZE);
}

void reseal(uint8_t *data, size_t size) {
    box_list list;
    box_list_make(data, size, &list);
    size_t index = NO_PARENT;
    for (size_t i = 0; i < list.count; i++) {
        const listed_box *box = &list.box[i];
        size_t end = box->offset + box->size;
        if (box->parent != NO_PARENT) break; /* those of the top level come first */
        if (box->type == GVC_BOX_MOOF) reseal_moof(data, size, &list, i);
        if (box->type == GVC_BOX_MOOV) seal(data, 0, end);
        if (box->type == GVC_BOX_GGAP) seal(data, box->offset, end);
        if (box->type == GVC_BOX_MFRA) index = i;
    }
    if (index != NO_PARENT) reseal_index(data, &list, index);
}
