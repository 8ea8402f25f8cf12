"""kill -9 in a path-traced render that keeps its samples, in an experiment, and in a fit: nothing half-written, and what goes on has the
bits of what was never broken off. Part of bad_input.py, whose runs and reports it is given."""
import json
import random
import shutil
import subprocess
import time

FLOW = """name = "flow"
[flow]
duration = 0.16
box = { lo = [0, 0, 0], hi = [1, 1, 1] }
[fluid]
gravity = [0, -9.8, 0]
expansion = 0.1
[[source]]
region = { type = "sphere", center = [0.5, 0.3, 0.5], radius = 0.2 }
density = 1
temperature = 10
"""


class KillAndResume:
    def __init__(self, program, work, run, project, fail, ok):
        self.program, self.work, self.run, self.project, self.fail, self.ok = program, work, run, project, fail, ok

    def killed_after(self, arguments, seconds):
        process = subprocess.Popen([self.program, *arguments], cwd=self.work, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(seconds)
            return False  # it was faster
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return True

    def same_pictures(self, name, one, other):
        for layer in ('mean', 'se', 'order.1', 'order.rest', 'max_sample', 'batch.07'):
            bits = []
            for file in (one, other):
                if self.run(['convert', str(file), 'looked.pfm', '--layer', layer]).returncode:
                    return self.fail(name, f'{file} has no sound layer {layer}')
                bits.append((self.work / 'looked.pfm').read_bytes())
            if bits[0] != bits[1]:
                return self.fail(name, f'layer {layer} differs')
        self.ok(name, 'same bits')

    def render(self):
        render = ['render', 'good.toml', '-m', 'path_tracer', '--override', 'film.width=48', '--override', 'film.height=36',
                  '--samples', '4096', '-o']
        begin = time.monotonic()
        if self.run([*render, 'whole.exr', '--cache', 'kept whole']).returncode:
            return self.fail('kill, render', 'the unbroken render fails')
        seconds, kills = time.monotonic() - begin, 0
        for share in (0.1, 0.4, 0.7, 0.9):
            kills += self.killed_after([*render, 'broken.exr', '--cache', 'kept'], share * seconds)
        if self.run([*render, 'broken.exr', '--cache', 'kept']).returncode:
            return self.fail('kill, render', 'going on fails')
        self.same_pictures(f'kill, render ({seconds:.1f} s, killed {kills} times)', 'broken.exr', 'whole.exr')

    def experiment(self, experiment):
        experiment = experiment.replace('samples = 64', 'samples = 4096') + 'overrides = { "film.width" = 48, ' \
            '"film.height" = 36 }\n'
        whole, broken = self.project('unbroken', experiment), self.project('broken', experiment)
        begin = time.monotonic()
        if self.run(whole).returncode:
            return self.fail('kill, experiment', 'the unbroken run fails')
        seconds, kills = time.monotonic() - begin, 0
        for share in (0.1, 0.4, 0.7, 0.85):
            kills += self.killed_after([*broken, '--resume'], share * seconds)
            for file in (self.work / 'broken' / 'results').rglob('*.exr'):
                if self.run(['convert', str(file), 'looked.png']).returncode:
                    self.fail('kill, experiment', f'{file} is half-written')
        done = self.run([*broken, '--resume'])
        if done.returncode or done.stderr:
            return self.fail('kill, experiment', f'resuming fails: {done.stderr!r}')
        tables = [(self.work / p / 'results' / 'g' / 'e' / 'table.csv').read_text().splitlines() for p in ('unbroken', 'broken')]
        heads = tables[0][0].split(',')
        for one, other in zip(*tables):
            for head, a, b in zip(heads, one.split(','), other.split(',')):
                if a != b and not head.startswith(('seconds', 'prepare', 'runs', 'stage')):
                    self.fail('kill, experiment', f'{head}: {a} and {b}')
        images = [sorted((self.work / p / 'results' / 'images').rglob('reference.exr')) for p in ('unbroken', 'broken')]
        if len(images[0]) != 1 or len(images[1]) != 1:
            return self.fail('kill, experiment', 'there is no reference image')
        bits = []
        for i, (file,) in enumerate(images):
            self.run(['convert', str(file), f'bits{i}.pfm'])
            bits.append((self.work / f'bits{i}.pfm').read_bytes())
        if bits[0] != bits[1]:
            return self.fail('kill, experiment', 'the references differ')
        self.ok('kill, experiment', f'{seconds:.1f} s, killed {kills} times: same bits')

    def record_of(self, folder):
        """What a fit says of itself, but for times and the checksum, which covers them; of nothing yet, None. Throws where it is half-written."""
        if not (folder / 'record.json').exists():
            return None
        record = json.loads((folder / 'record.json').read_text())
        for frame in record['frames']:
            del frame['seconds']
        del record['checksum']
        return record

    def fit(self):
        """Killed at 30 random moments, of the first run and of those that go on: whatever lies there at any time is of the unbroken run."""
        name, moments = 'kill, fit', random.Random(1)
        (self.work / 'burst.toml').write_text(FLOW)
        if self.run(['simulate', 'burst.toml', '--out', 'burst', '--set', 'n=32']).returncode:
            return self.fail(name, 'there is no smoke')
        smoke = sorted(str(f) for f in (self.work / 'burst').glob('*.vdb'))  # five frames, the first of them empty
        begin = time.monotonic()
        if self.run(['fit', *smoke, '-n', '150', '--out', 'whole fit']).returncode:
            return self.fail(name, 'the unbroken fit fails')
        seconds, kills, done, finished = time.monotonic() - begin, 0, [], 0
        whole, broken = self.work / 'whole fit', self.work / 'broken' / 'fit'
        record = self.record_of(whole)
        expected = {f.name: f.read_bytes() for f in whole.iterdir() if f.suffix != '.json'}
        if len(expected) != 2 * len(smoke) or len(record['frames']) != len(smoke):
            return self.fail(name, f'the unbroken fit left {sorted(expected)}')
        while (kills < 30 and finished < 100) or broken.exists():
            killed = self.killed_after(['fit', *smoke, '-n', '150', '--out', str(broken)],
                                       moments.uniform(0, seconds) if kills < 30 else 60)
            files = list(broken.iterdir()) if broken.exists() else []
            for file in files:
                if file.suffix in ('.csv', '.residual') and file.read_bytes() != expected.get(file.name):
                    return self.fail(name, f'after {kills} kills {file.name} is not that of the unbroken run')
            try:
                there = self.record_of(broken)
            except ValueError as reason:
                return self.fail(name, f'after {kills} kills the record is half-written: {reason}')
            frames = len(there['frames']) if there else 0
            if there and there['frames'] != record['frames'][:frames]:
                return self.fail(name, f'after {kills} kills the record is not that of the unbroken run')
            if killed:
                kills += 1
                done.append(frames)
                continue
            finished += 1
            left = {f.name for f in files if f.suffix in ('.csv', '.residual')}
            if left != set(expected) or there != record:
                return self.fail(name, f'after {kills} kills: {sorted(left)}, {frames} frames in the record')
            shutil.rmtree(broken)
        if kills != 30 or len(set(done)) < 3:
            return self.fail(name, f'{kills} kills, with {done} frames done, {finished} runs to the end: no test')
        self.ok(name, f'{seconds:.2f} s, killed {kills} times with {done} frames done, {finished} runs to the end: same bits')
