#!/usr/bin/env python3
"""Runs a program that can start threads but no processes (a seccomp filter answers EPERM).
usage: without_processes.py PROGRAM [ARGUMENT ...]"""
import ctypes
import os
import platform
import struct
import sys

PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 38, 22, 2
ALLOW, ERRNO = 0x7fff0000, 0x00050000
EPERM, ENOSYS = 1, 38
CLONE_THREAD = 0x00010000
# Numbers of clone, fork and vfork; clone3 has the same everywhere, and its flags are out of a filter's sight.
CALLS = {"x86_64": (56, 57, 58), "aarch64": (220, None, None)}
CLONE3 = 435
LOAD, JUMP_IF_EQUAL, JUMP_IF_SET, RETURN = 0x20, 0x15, 0x45, 0x06
NUMBER, FIRST_ARGUMENT = 0, 16  # of seccomp_data


def forbid_processes():
    """Of this process and what it becomes. False where that is not possible."""
    if platform.machine() not in CALLS:
        return False
    clone, *forks = CALLS[platform.machine()]
    steps = [(LOAD, 0, 0, NUMBER)]
    for call in filter(None, forks):
        steps += [(JUMP_IF_EQUAL, 0, 1, call), (RETURN, 0, 0, ERRNO | EPERM)]
    steps += [(JUMP_IF_EQUAL, 0, 1, CLONE3), (RETURN, 0, 0, ERRNO | ENOSYS),  # the C library then takes clone
              (JUMP_IF_EQUAL, 0, 3, clone), (LOAD, 0, 0, FIRST_ARGUMENT),
              (JUMP_IF_SET, 1, 0, CLONE_THREAD), (RETURN, 0, 0, ERRNO | EPERM), (RETURN, 0, 0, ALLOW)]
    filters = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in steps))
    program = ctypes.create_string_buffer(struct.pack("HP", len(steps), ctypes.addressof(filters)))
    prctl = ctypes.CDLL(None, use_errno=True).prctl
    return (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0
            and prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.c_void_p(ctypes.addressof(program)), 0, 0) == 0)


if __name__ == "__main__":
    if not forbid_processes():
        sys.exit("this machine has no filters of system calls")
    os.execvp(sys.argv[1], sys.argv[1:])
