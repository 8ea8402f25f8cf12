#!/usr/bin/env python3
"""Mutated input of every kind through the command line. For each: no crash, no sanitizer's report, no 'unexpected failure', an exit code
from 0 to 3, at most one line on standard error without control characters, at most 20 s of the processor and 2 GiB, no temporary file left behind.

usage: fuzz.py DRIVER PROGRAM SOURCE_FOLDER [--count N | --seconds S] [--seed S] [--targets A,B] [--jobs N] [--only TARGET:INDEX] [--keep FOLDER]
               [--limit S]

DRIVER is the test program airlight_fuzz, PROGRAM is airlight. An input is given again by its seed, target and index; --keep leaves those that fail
in FOLDER. The target vectors_costly is run where it is named alone: it needs a --limit of 120 s. With sanitizers memory is limited to three times as much, which is what their bookkeeping takes.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unicodedata

import flow_targets
import targets

ALL = targets.ALL | flow_targets.ALL
MOST_KIB = 2 << 20


class Runner:
    """One driver in a folder of its own."""

    def __init__(self, options, folder):
        self.options = options
        self.sanitized = b'__asan_init' in pathlib.Path(options.driver).read_bytes()
        self.environment = dict(os.environ, AIRLIGHT_GPU='none', AIRLIGHT_DATA='',
                                ASAN_OPTIONS='detect_leaks=0:quarantine_size_mb=16:allocator_may_return_null=1', UBSAN_OPTIONS='print_stacktrace=1')
        self.box = targets.Box(folder, options.source, os.path.abspath(options.program))
        self.start()

    def start(self):
        self.driver = subprocess.Popen([os.path.abspath(self.options.driver), str(self.options.limit)], cwd=self.box.folder, env=self.environment,
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def judge(self, result):
        """What is wrong, or nothing."""
        error = result['error'].encode('latin-1')
        if result['signal'] in (14, 24) or (result['signal'] == 9 and result['seconds'] > self.options.limit - 1):
            return f'hangs ({result["seconds"]:.0f} s)'
        for word in (b'AddressSanitizer', b'runtime error:', b'LeakSanitizer', b'terminate called', b'Assertion'):
            if word in error:
                return f'{word.decode()}: {error[error.find(word):][:300]!r}'
        if result['signal'] is not None:
            return f'signal {result["signal"]}: {error[:300]!r}'
        if result['code'] not in (0, 1, 2, 3):
            return f'exit code {result["code"]}: {error[:300]!r}'
        if b'unexpected failure' in error:
            return f'{error[:300]!r}'
        if result['kib'] > MOST_KIB * (3 if self.sanitized else 1):
            return f'{result["kib"] / 2 ** 20:.2f} GiB'
        return self.judge_text(error, result['code'])

    @staticmethod
    def judge_text(error, code):
        try:
            text = error.decode()
        except UnicodeDecodeError:
            return f'standard error is not UTF-8: {error[:300]!r}'
        lines = text.split('\n')[:-1]
        if text and not text.endswith('\n'):
            return f'a line without an end: {text[:300]!r}'
        if code == 2 and len(lines) != 1:
            return f'{len(lines)} lines on standard error: {text[:300]!r}'
        for line in lines:
            if any(unicodedata.category(c) in ('Cc', 'Zl', 'Zp') for c in line):
                return f'control characters on standard error: {text[:300]!r}'
            if not line.startswith('airlight: ') or len(line) > 1100:
                return f'not a clear line: {text[:300]!r}'
        return None

    def strange(self):
        """What no command may do: write through a link, run a name, or write beside the folder."""
        victim = self.box.folder / 'victim'
        if victim.is_symlink() or victim.read_text() != targets.VICTIM:
            self.box.write('victim', targets.VICTIM)
            return 'a file was written through a link'
        for name in ('run', '../run', '../evil', '/evil'):
            if (self.box.folder / name).exists():
                return f'{name} was made'
        return None

    def one(self, target, index):
        r = random.Random(f'{self.options.seed} {target} {index}')
        arguments = (ALL | targets.COSTLY)[target](r, self.box)
        self.driver.stdin.write(json.dumps(arguments) + '\n')
        self.driver.stdin.flush()
        answer = self.driver.stdout.readline()
        if not answer:
            self.driver.wait()
            self.start()
            return {'error': '', 'seconds': 0, 'kib': 0, 'code': None}, 'the driver itself ended', arguments
        result = json.loads(answer)
        wrong = self.judge(result)
        left = [str(p.relative_to(self.box.folder)) for p in self.box.folder.rglob('*.tmp')]
        for name in left:
            (self.box.folder / name).unlink()
        if not wrong and left:
            wrong = f'left behind: {left}'
        if not wrong and (stranger := self.strange()):
            wrong = stranger
        if wrong and self.options.keep:
            kept = pathlib.Path(self.options.keep) / f'{target}_{index}'
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(self.box.folder, kept, symlinks=True,
                            ignore=lambda folder, names: [n for n in names if pathlib.Path(folder, n).is_fifo()])
            (kept / 'arguments.json').write_text(json.dumps(arguments))
        return result, wrong, arguments


def work(options, items, end, number):
    """Runs one input after the other; returns (inputs, codes, failures, seconds and memory at most of each target)."""
    memory = '/dev/shm' if os.access('/dev/shm', os.W_OK) else None
    folder = tempfile.mkdtemp(prefix='airlight_fuzz_', dir=memory)
    done, failures, codes, most = 0, [], {}, {}
    try:
        runner = Runner(options, folder)
        for target, index in items:
            if time.monotonic() > end:
                break
            result, wrong, arguments = runner.one(target, index)
            done += 1
            codes[(target, result['code'])] = codes.get((target, result['code']), 0) + 1
            seconds, kib = most.get(target, (0, 0))
            most[target] = max(seconds, result['seconds']), max(kib, result['kib'])
            if wrong:
                failures.append((target, index, wrong))
                print(f'FAILED {target}:{index}: {wrong}\n       {" ".join(map(repr, arguments))[:300]}', flush=True)
            elif options.only:
                print(f'ok     {target}:{index}: code {result["code"]}, {result["seconds"]:.2f} s, {result["error"].strip()[:300]}')
            if done % 2000 == 0 and not options.quiet:
                print(f'worker {number}: {done} inputs', flush=True)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return done, codes, failures, most


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('driver')
    parser.add_argument('program')
    parser.add_argument('source')
    parser.add_argument('--count', type=int, default=1000, help='inputs, shared among the targets')
    parser.add_argument('--first', type=int, default=0, help='index of the first input of each target')
    parser.add_argument('--seconds', type=float, default=1e9, help='ends after that time, whatever is left')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--targets', default=','.join(ALL))
    parser.add_argument('--limit', type=int, default=20, help='seconds of the processor that an input may take')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--only', help='TARGET:INDEX, this input alone')
    parser.add_argument('--keep', help='folder for inputs that fail')
    parser.add_argument('--quiet', action='store_true')
    options = parser.parse_args()
    names = options.targets.split(',')
    if unknown := [n for n in names if n not in ALL | targets.COSTLY]:
        sys.exit(f'unknown targets {unknown}, expected some of {list(ALL | targets.COSTLY)}')
    if options.only:
        target, index = options.only.split(':')
        items = [(target, int(index))]
    else:
        each = -(-options.count // len(names))
        items = [(name, index) for index in range(options.first, options.first + each) for name in names]
    begin = time.monotonic()
    jobs = max(1, min(options.jobs, len(items)))
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        parts = [pool.submit(work, options, items[i::jobs], begin + options.seconds, i) for i in range(jobs)]
        results = [p.result() for p in parts]
    done, failures = sum(r[0] for r in results), [f for r in results for f in r[2]]
    codes, mosts = {}, {}
    for r in results:
        for (target, code), count in r[1].items():
            codes.setdefault(target, {})[code] = codes.get(target, {}).get(code, 0) + count
        for target, most in r[3].items():
            mosts[target] = [max(pair) for pair in zip(mosts.get(target, (0, 0)), most)]
    if not options.quiet:
        for target, counts in codes.items():
            wrong = sum(f[0] == target for f in failures)
            print(f'{target:12} {sum(counts.values())} inputs, {wrong} failures, at most {mosts[target][0]:.1f} s and '
                  f'{mosts[target][1] / 2 ** 10:.0f} MiB; ' + ', '.join(f'exit code {c}: {n}' for c, n in sorted(counts.items(), key=str)))
    most = [max((m[i] for m in mosts.values()), default=0) for i in (0, 1)]
    print(f'{done} inputs in {time.monotonic() - begin:.0f} s, {len(failures)} failures; at most {most[0]:.1f} s and {most[1] / 2 ** 10:.0f} MiB')
    # A target that never succeeds, or is never refused, tests nothing.
    for target, counts in codes.items():
        # A journal is passed over where it is damaged, a link is replaced: no input of those targets need be refused.
        refused = counts.get(2, 0) > 0 or target in ('journal', 'links')
        if sum(counts.values()) >= 100 and (not refused or counts.get(0, 0) + counts.get(1, 0) == 0):
            print(f'FAILED {target}: all of its inputs end alike')
            failures.append((target, -1, 'alike'))
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
