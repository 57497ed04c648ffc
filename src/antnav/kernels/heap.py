"""A heap with four children a node, to be compiled in the file of each kernel that uses it.

`keys` and `items` are arrays of one length; nobody looks at what lies behind the first `size`.
"""

from __future__ import annotations


def push(keys, items, size, key, item):
    """Put an item into a heap of `size` items, with room for one more; a hole moves up instead of swaps."""
    i = size
    while i > 0:
        parent = (i - 1) >> 2
        if keys[parent] <= key:
            break
        keys[i] = keys[parent]
        items[i] = items[parent]
        i = parent
    keys[i] = key
    items[i] = item


def pop(keys, items, size):
    """Take the least item from a heap of `size` items."""
    item = items[0]
    size -= 1
    key, moved = keys[size], items[size]
    i = 0
    while 4 * i + 1 < size:
        first = 4 * i + 1
        if first + 4 <= size:  # without a branch for each child, which the processor could only guess
            one = first + (keys[first + 1] < keys[first])
            two = first + 2 + (keys[first + 3] < keys[first + 2])
            least = two if keys[two] < keys[one] else one
        else:
            least = first
            for child in range(first + 1, size):
                if keys[child] < keys[least]:
                    least = child
        if keys[least] >= key:
            break
        keys[i] = keys[least]
        items[i] = items[least]
        i = least
    keys[i] = key
    items[i] = moved
    return item
