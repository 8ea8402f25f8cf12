"""kill -9 in a path-traced render that keeps its samples, and in an experiment: nothing half-written, and what goes on has the bits of what
was never broken off. Part of bad_input.py, whose runs and reports it is given."""
import subprocess
import time


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
