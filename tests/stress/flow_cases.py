"""Cases of bad_input.py: problems that cannot flow, settings of the wrong type, a disk that is full."""
FLOW = 'name = "flow"\n[flow]\nduration = 0.1\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n'


def queue(case, write, limit_files):
    def simulate(name, text, says, sets=('n=8',), **more):
        case(f'flow: {name}', ['simulate', write(f'flow {name}.toml', text), '--out', f'flow {name}', *(w for s in sets for w in ('--set', s))],
             says=says, **more)

    for name, text, says in [
            ('empty', '', 'found an empty file'), ('no flow', '[fluid]\n', "missing key 'flow'"),
            ('box of no size', FLOW.replace('[1, 1, 1]', '[1, 0, 1]'), '.toml:4:30: flow: box: hi = [1, 0, 1], expected a corner'),
            ('box with nan', FLOW.replace('[0, 0, 0]', '[0, 0, nan]'), 'lo[2] = nan, expected'),
            ('box of no whole cells', FLOW.replace('[1, 1, 1]', '[1, 0.9, 1]'), 'are 7.2 along y, expected a whole number'),
            ('no time', FLOW.replace('0.1', '0'), '.toml:3:12: flow: duration = 0, expected'),
            ('no frame', FLOW.replace('0.1', '0.02'), 'less than half a frame'),
            ('frames for ever', FLOW.replace('0.1', '1e9'), 'at most 1e+07 frames'),
            ('negative viscosity', FLOW + '[fluid]\nviscosity = -1\n', '.toml:6:13: fluid: viscosity = -1, expected'),
            ('source outside', FLOW + '[[source]]\nregion = { type = "sphere", center = [5, 5, 5], radius = 1 }\ndensity = 1\n',
             'lies outside the box'),
            ('source between samples', FLOW + '[[source]]\nregion = { type = "sphere", center = [0.5, 0.5, 0.5], radius = 0.01 }\ndensity = 1\n',
             'holds no sample'),
            ('filled', FLOW + '[[obstacle]]\ntype = "box"\nlo = [-1, -1, -1]\nhi = [2, 2, 2]\n', 'the obstacles fill the box'),
            ('inflow', FLOW + '[sides]\nleft = { type = "inflow", velocity = [2, 0, 0] }\n', '2 m^3/s flow into the box'),
            ('inflow behind a wall', FLOW + '[sides]\nleft = { type = "inflow", velocity = [2, 0, 0] }\nright = { type = "open" }\n'
             '[[obstacle]]\ntype = "box"\nlo = [0.4, -1, -1]\nhi = [0.7, 2, 2]\n', '2 m^3/s flow into a part of 192 cells'),
            ('too strong', FLOW + '[start]\ndensity = 1e20\n[fluid]\ngravity = [0, -1e6, 0]\nweight = 1e30\n', 'step 1, t = 0 s: the velocity along y at cell')]:
        simulate(name, text, says)
    for setting, says in [('n=0', 'n = 0 is out of range'), ('n=2147483648', 'out of range'), ('n=9.5', 'expected an integer'), ('n=', 'expected'),
                          ('dt=-1', 'dt = -1 is out of range'), ('dt=nan', 'expected a number'), ('dt=1e-300', 'steps of a frame'),
                          ('scheme=3', 'expected one of'), ('tolerance=0', 'out of range'), ('precision=half', 'expected one of'),
                          ('project_twice=2', 'expected true or false'), ('speed=1', "unknown setting 'speed'")]:
        simulate(f'with {setting}', FLOW, says, [setting])
    simulate('onto a full disk', FLOW, 'flow onto a full disk/', preexec_fn=limit_files)
    case('flow: output is a file', ['simulate', 'flow onto a full disk.toml', '--out', 'flow onto a full disk.toml'])
