"""The compiled tick: the one place that says what it does, for the loop, blocks and replay.

`advance` takes where the array is and what is wanted, decides what belongs under the hand, makes
the frame and fills the tick's record; `replay` makes the frames again from records. Both show a
tick by the same function, so that what is replayed is what was sent, bit for bit.

Whatever changes without the hand's doing - a new line, a tuning, a jump, the start, a pause,
rest, a page's next line - fades from the frame last sent. So does what the hand moved in a gap
without poses or frames. A fade goes by ticks: a loop that was held up would jump if it took the
time that it lost for time in which it faded. So does the time of a picture that moves by itself.
"""

import numpy as np
from numba import njit

from vbraille.caching import keep_compiled
from vbraille.engine.constants import (
    APART_NS,
    CATCH_NS,
    DIFFERENCE,
    FADE_NS,
    IDLE_NS,
    JUMP_MM_S,
    MEAN,
    NS_PER_S,
    PAUSE_FADE_NS,
    REACH_MM,
    SILENCE_NS,
    STILL_MM,
)
from vbraille.engine.record import (
    FLAGS,
    FLOATS,
    INTS,
    PART,
    SHARE,
    SHOWN,
    SIGNAL,
    THETA,
    VX,
    VY,
    Flag,
    X,
    Y,
)
from vbraille.render import work
from vbraille.render.frames import blend, copy
from vbraille.render.kernels import SCENE, frame, part_of, patience, seamless, too_far
from vbraille.render.signalkernels import begin, compute

_PAUSED, _SILENT, _RESTING = int(Flag.PAUSED), int(Flag.SILENT), int(Flag.RESTING)
_CHANGED, _RESTED, _HELD = int(Flag.CHANGED), int(Flag.RESTED), int(Flag.HELD)
_TURNED, _UNFELT = int(Flag.TURNED), int(Flag.UNFELT)
# What a tick is given, each a row of float64; times are whole numbers that fit into one.
(POSED, POSE_X, POSE_Y, POSE_THETA) = range(4)
_NOWHERE_MM = 1e6

# All that a tick knows from those before it.
# The numbers of a tick's record come first, the whole ones and the others.
WHOLE = (
    *INTS,
    # What does not change: durations that follow from the rate, and whether there is an axis y.
    "period_ns", "gap_ns", "step_ns", "free_y",
    "serial",  # how many pictures were wanted under the hand, and so the last one's number
    "paused",
    "switches",  # states of a scene's switches, three bits for each signal
    "sent_ns",  # when a frame last went out
    "faded_ns", "fading_ns",  # how far a fade has come, and how long it takes
    "placed",  # whether it is known where the array is
    "sampled_ns",  # when the last pose came, by our clock
    "moved_ns",  # when the hand last moved
    "shown",  # serial number of what is under the hand; 0 at rest
    "turned",  # whether the array is turned too far for what is wanted
    "begun", "shown_ns",  # the picture whose own time goes, and that time
    "rested",  # how often the device has gone to rest by itself
    "samples",  # of the velocity
)  # fmt: skip
_REAL = (
    *FLOATS,
    "own_y_mm",  # the carriage's y; a slider has none, and its record has the picture's
    "moved_x_mm", "moved_y_mm", "moved_theta",  # where the hand last moved to
)  # fmt: skip
STATE = np.dtype([(name, "<i8") for name in WHOLE] + [(name, "<f8") for name in _REAL])

_compiled = njit(cache=keep_compiled(), error_model="numpy", nogil=True)


@_compiled
def add_velocity(now, window, velocities, time_ns, x_mm, y_mm):
    """Take one more pose into the velocity: Lévesque 2009, eqs. 9.4 and 9.5.

    The velocity is the mean of the last 50 differences over 10 poses, in x, y and θ. Before the
    first pose, and before a gap or a step back in time, the hand is taken to have stood still.
    """
    if now["samples"] > 0:
        step_ns = time_ns - now["device_ns"]
        if step_ns == 0:
            return
        if not 0 < step_ns < APART_NS:
            forget_velocity(now, velocities)
    place = window[now["samples"] % DIFFERENCE]
    if now["samples"] >= DIFFERENCE:
        row = now["samples"] % MEAN
        elapsed_s = (time_ns - place[0]) / NS_PER_S
        velocities[row, 0] = (x_mm - place[1]) / elapsed_s
        velocities[row, 1] = (y_mm - place[2]) / elapsed_s
        vx = 0.0
        vy = 0.0
        for n in range(MEAN):
            vx += velocities[n, 0]
            vy += velocities[n, 1]
        now["vx_mm_s"] = vx / MEAN
        now["vy_mm_s"] = vy / MEAN
    place[0], place[1], place[2] = time_ns, x_mm, y_mm
    now["samples"] += 1


@_compiled
def forget_velocity(now, velocities):
    """Forget how the hand moved."""
    now["samples"] = 0
    now["vx_mm_s"] = 0.0
    now["vy_mm_s"] = 0.0
    velocities[:] = 0.0


@_compiled
def _change(now, fade_ns):
    """Begin to fade from the frame last sent."""
    now["flags"] |= _CHANGED
    now["fading_ns"] = fade_ns
    now["faded_ns"] = 0


@_compiled
def _far_mm(x_mm, y_mm, theta_rad):
    """Return how far actuators move by a step along x, along y and a turn, at most."""
    return max(abs(x_mm), abs(y_mm), REACH_MM * abs(theta_rad))


@_compiled
def _take_pose(now, window, velocities, device_ns, pose):
    """Take the pose of a tick; tell whether the array can be there."""
    now_ns, x, y, theta = now["time_ns"], pose[POSE_X], pose[POSE_Y], pose[POSE_THETA]
    # Each is compared by itself: a NaN fails every comparison, but `max` may hide it.
    if not (abs(x) < _NOWHERE_MM and abs(y) < _NOWHERE_MM):
        return False
    if not REACH_MM * abs(theta) < _NOWHERE_MM:
        return False
    if now["free_y"] == 0:
        y = 0.0  # a slider has no y: it stands at the picture's own
    moved = True
    if now["placed"] == 0:
        now["placed"] = 1
        now["part"] = work.NO_PART
    else:
        step = x - now["x_mm"]
        elapsed_ns = max(now_ns - now["sampled_ns"], now["period_ns"])
        # Poses that were late come with the next one: only the device's clock tells of such a gap.
        gap_ns = max(elapsed_ns, min(device_ns - now["device_ns"], SILENCE_NS))
        far_mm = _far_mm(step, y - now["own_y_mm"], theta - now["theta_rad"])
        if far_mm > JUMP_MM_S * gap_ns / NS_PER_S:
            # No hand is so fast: the carriage was lost and found again.
            forget_velocity(now, velocities)
            _change(now, FADE_NS)
        else:
            # A fade that is under way is not begun anew, or it would never end on a slow line.
            fading = now["faded_ns"] < now["fading_ns"]
            if gap_ns > now["gap_ns"] and now["shown"] != 0 and not fading:
                _change(now, CATCH_NS)
            if step > 0:
                now["forward_mm"] += step
                now["forward_s"] += elapsed_ns / NS_PER_S
        moved_mm = _far_mm(x - now["moved_x_mm"], y - now["moved_y_mm"], theta - now["moved_theta"])
        moved = moved_mm > STILL_MM
    add_velocity(now, window, velocities, device_ns, x, y)
    now["device_ns"] = device_ns
    now["x_mm"], now["own_y_mm"], now["theta_rad"] = x, y, theta
    now["sampled_ns"] = now_ns
    if moved:
        now["moved_x_mm"], now["moved_y_mm"], now["moved_theta"] = x, y, theta
        now["moved_ns"] = now_ns
    return True


@_compiled
def _decide(now, y_mm, rested, taking, numbers):
    """Decide what is shown in this tick, how far it has faded in, and what is remarked on it."""
    if rested != now["rested"]:
        now["rested"] = rested
        now["flags"] |= _RESTED
        _change(now, FADE_NS)
    if not taking:
        now["shown"] = 0
        now["faded_ns"] = now["fading_ns"]
    turned = now["placed"] != 0 and too_far(numbers, now["theta_rad"], now["turned"] != 0)
    now["turned"] = 1 if turned else 0
    silent = now["time_ns"] - now["sampled_ns"] > SILENCE_NS
    away = now["placed"] == 0 or turned or not taking or silent
    # A picture that moves by itself is felt without moving the hand, though not without end.
    still_ns = now["time_ns"] - now["moved_ns"]
    idle = still_ns > patience(numbers) * NS_PER_S
    idle = idle or (numbers[work.FREQUENCY] == 0.0 and still_ns > IDLE_NS)
    # Serial number of the picture that belongs under the hand now; 0 is rest.
    wanted = 0 if now["paused"] or away or idle else now["serial"]
    # A finger at the edge of its line stays on it over a rest, and when the page comes in another
    # style, too.
    part = part_of(numbers, y_mm, now["part"])
    if wanted != now["shown"]:
        if wanted != now["begun"] and wanted != 0:
            now["begun"] = wanted
            now["shown_ns"] = 0
        now["shown"] = wanted
        _change(now, PAUSE_FADE_NS if now["paused"] else FADE_NS)
    elif wanted != 0 and part != now["part"] and not seamless(numbers):
        _change(now, FADE_NS)
    now["part"] = part
    fading = now["faded_ns"] < now["fading_ns"]
    now["share"] = now["faded_ns"] / now["fading_ns"] if fading else 1.0
    unfelt = now["serial"] != 0 and not now["paused"] and (away or now["flags"] & _RESTED)
    now["flags"] |= (
        _RESTING * (wanted == 0)
        + _PAUSED * (now["paused"] != 0)
        + _SILENT * silent
        + _HELD * (not taking)
        + _TURNED * turned
        + _UNFELT * (unfelt != 0)
    )


@_compiled
def _make(numbers, table, scratch, at, own, flags, part, output, held, target):
    """Make the frame of a tick from the one before it, and compute the signals of its picture.

    The first tick of a change still sends the old frame, the last one the new one alone.

    Parameters
    ----------
    numbers, table, scratch
        The program that is wanted under the hand.
    at : float64[AT]
        Memory of the signals, and the time of the picture at the tick before.
    own : float64[FLOATS]
        Numbers of the tick's record.
    flags, part
        Flags of the record, and its part of the picture.
    output, held, target : float64[rows, columns]
        The frame of the tick before, which is changed, the one that the fade began with, and room
        for another.
    """
    before_s = at[work.TIME]
    if own[X] == own[X]:  # its place is known
        at[work.X], at[work.Y], at[work.THETA] = own[X], own[Y], own[THETA]
    at[work.TIME], at[work.VX], at[work.VY] = own[SHOWN], own[VX], own[VY]
    if numbers[work.KIND] == SCENE:
        if at[work.TIME] == 0.0:
            begin(numbers, at)
        compute(numbers, at, max(at[work.TIME] - before_s, 0.0))
    if flags & _RESTED:
        output[:] = 0.0
    if flags & _CHANGED:
        copy(output, held)
    if flags & _RESTING:
        target[:] = 0.0
    else:
        frame(numbers, table, scratch, part, at, target)
    if own[SHARE] < 1.0:
        blend(held, target, own[SHARE], output)
    else:
        copy(target, output)


@_compiled
def advance(
    state,
    own_ints,
    own_floats,
    window,
    velocities,
    output,
    held,
    target,
    at,
    numbers,
    table,
    scratch,
    times_ns,
    poses,
    rested,
    taking,
    ints,
    floats,
    frames,
    first,
):
    """Do ticks and return how many; it stops before one whose pose is not possible.

    Parameters
    ----------
    state, own_ints, own_floats, window, velocities, output, held, target, at
        What is known from earlier ticks, a `STATE`, and room to work in.
        The whole numbers and the numbers of a tick's record are the first of their kind in the
        state, of which there are views.
    numbers, table, scratch
        The program that is wanted under the hand.
    times_ns : int64[n, 2]
        When each tick woke, and the device's time of its pose.
    poses : float64[n, 4]
        A row for each tick: 1 if it has a pose and 0 if not, then x and y in mm and θ in rad.
    rested : int
        How often the device has gone to rest by itself.
    taking : bool
        Whether frames reach the actuators.
    ints, floats, frames
        The records to fill, as `vbraille.engine.record.columns_of` gives them.
    first : int
        Which record takes the first tick; after the last record, record 0 is next.
    """
    now = state[0]
    for n in range(times_ns.shape[0]):
        now_ns = times_ns[n, 0]
        passed_ns = min(now_ns - now["time_ns"], now["step_ns"])
        now["time_ns"], now["flags"] = now_ns, 0
        if now["shown"] != 0:
            now["shown_ns"] += passed_ns
        unsent_ns = now_ns - now["sent_ns"]
        fading = now["faded_ns"] < now["fading_ns"]
        if unsent_ns > now["gap_ns"] and now["shown"] != 0 and not fading:
            _change(now, CATCH_NS)
        # A frame that went out late has only just moved the actuators.
        now["faded_ns"] += max(min(passed_ns, unsent_ns), 0)
        posed = poses[n, POSED] != 0.0
        if posed and not _take_pose(now, window, velocities, times_ns[n, 1], poses[n]):
            return n
        placed = now["placed"] != 0
        y_mm = now["own_y_mm"] if placed and now["free_y"] != 0 else numbers[work.OWN_Y]
        _decide(now, y_mm, rested, taking, numbers)
        now["shown_s"] = now["shown_ns"] / NS_PER_S
        if placed:
            now["y_mm"] = y_mm
        at[work.SWITCHES] = now["switches"]
        if not taking:
            output[:] = 0.0
        flags, part = now["flags"], now["part"]
        _make(numbers, table, scratch, at, own_floats, flags, part, output, held, target)
        slot = (first + n) % ints.shape[0]
        for k in range(own_ints.shape[0]):
            ints[slot, k] = own_ints[k]
        for k in range(SIGNAL):
            floats[slot, k] = own_floats[k]
        for k in range(work.MOST_SIGNALS):
            floats[slot, SIGNAL + k] = at[work.SIGNAL + k]
        for row in range(output.shape[0]):
            for column in range(output.shape[1]):
                frames[slot, row, column] = output[row, column]
        now["tick"] += 1
        now["sent_ns"] = now_ns  # the loop knows better, if it sends the frame
    return times_ns.shape[0]


@_compiled
def replay(numbers, table, scratch, ints, floats, at, output, held, target, frames):
    """Make the frames of ticks again from their records, all of one picture and without a gap.

    Signals are computed again. They are those that there were if the records begin with the
    picture's first, and no switch was pressed.

    Parameters
    ----------
    numbers, table, scratch
        The program that was wanted under the hand.
    ints, floats
        The records, of which part, flags, pose, velocity, time and share are used.
    at : float64[AT]
        Memory of the signals, and the time of the record before.
    output, held, target : float64[rows, columns]
        The frame written last, the one that the fade began with, and room for another; they and
        `at` are changed, for the ticks that come next.
    frames : float64[n, rows, columns]
        What the actuators did, to fill.
    """
    for n in range(ints.shape[0]):
        flags, part = ints[n, FLAGS], ints[n, PART]
        _make(numbers, table, scratch, at, floats[n], flags, part, output, held, target)
        if flags & _HELD:  # the actuators rested, though the loop goes on from its frame
            frames[n] = 0.0
        else:
            copy(output, frames[n])
