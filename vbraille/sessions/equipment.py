"""What a session is run with, if nobody brings their own: an engine, a live view, markers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices import open_device
from vbraille.devices.registry import find_driver
from vbraille.engine.host import Host
from vbraille.errors import InputError
from vbraille.sessions.planning.appearance import CONVENTIONAL
from vbraille.sessions.running.markers import Markers, parse_markers
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.display import Display
    from vbraille.sessions.conditions import Conditions
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.onlookers import Onlookers
    from vbraille.sessions.running.showing import RunEngine
    from vbraille.simulation.pointing import Pointer
    from vbraille.simulation.steering import Steering


def usual_engine(
    spec: str,
    wanted: Display,
    protocol: Protocol,
    plan: Plan,
    channels: Sequence[Steering | Pointer],
    *,
    fast: bool,
) -> RunEngine:
    """Make the usual engine: a process of its own, or a loop in this one if it runs fast.

    Parameters
    ----------
    spec, wanted
        Spec of the device, and the display that the protocol is written for.
    protocol, plan
        What the session shows, which says how much room a picture needs.
    channels
        Shared memory by which a simulated hand is moved, which the process inherits.
    fast
        Whether it runs as fast as the machine can.
    """
    if fast:
        from vbraille.engine.batch import BatchEngine

        return BatchEngine(open_device(spec, wanted), wanted.rate_hz)
    find_driver(spec)  # before anything is compiled for what is not there
    most = max(len(protocol.line(stimulus.masks)) for stimulus in plan.stimuli())
    inherited = [channel.descriptor for channel in channels]
    return Host(spec, wanted, protocol.model.style.room(wanted, most), pass_fds=inherited)


def usual_markers(conditions: Conditions) -> Markers | None:
    """Open the other recorder that is wanted; None if none is.

    Raises
    ------
    InputError
        If it cannot be opened.
    """
    if conditions.markers is None:
        return None
    from vbraille.sessions.running.markers import Markers

    return Markers(parse_markers(conditions.markers))


def usual_onlookers(
    protocol: Protocol, conditions: Conditions, pointer: Pointer | None
) -> Onlookers | None:
    """Make the pages of the live view that is wanted; None if none is.

    Parameters
    ----------
    protocol, conditions
        What the session shows, and what it is run with.
    pointer
        Pointer by which a page is the hand; None if no page may be.
    """
    live = conditions.live
    if live is None:
        return None
    # Imported here, since a session that nobody watches needs none of it.
    from vbraille.live.monitor import Monitor
    from vbraille.sessions.running.onlookers import LOOPBACK, Onlookers

    blind, steers = protocol.session.blind, pointer is not None
    monitor = Monitor(host=live.host, port=live.port, pointer=pointer, blind=blind, steers=steers)
    return Onlookers(monitor, blind=blind, host=live.host or LOOPBACK, simulated=steers)


def usual_beside(
    protocol: Protocol, plan: Plan, conditions: Conditions, *, felt: bool
) -> OnConventional | None:
    """Begin to drive the conventional display that the protocol needs; None if it needs none.

    Parameters
    ----------
    protocol, plan, conditions
        What the session shows, in which order, and what it is run with.
    felt
        Whether answers come from what is felt: a simulated reader compares nothing with what
        stands there.
    """
    if conditions.fast or felt or not protocol.stands_beside:
        return None
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.sessions.running.conventional import OnConventional

    spec = conditions.also or CONVENTIONAL
    cells = cells_needed(protocol, plan)
    table = protocol.conventional
    return OnConventional(ConventionalDisplay(spec), table, cells=cells, spec=spec)


def cells_needed(protocol: Protocol, plan: Plan) -> int:
    """Number of cells that a conventional display must have for all of a plan."""
    table = protocol.conventional
    shown = [stimulus.masks for stimulus in plan.stimuli() if stimulus.conventional]
    return max(len(table.placed(masks)) for masks in [table.reference, *shown])


def check_beside(protocol: Protocol, conditions: Conditions) -> None:
    """Check that the protocol and a conventional display go together.

    Raises
    ------
    InputError
        If they do not.
    """
    if conditions.also is not None and not protocol.stands_beside:
        raise InputError(
            f"{protocol.name} shows nothing on a conventional display; leave out {setting('also')}"
        )
    shows = any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions)
    if conditions.fast and shows:
        raise InputError(
            f"{protocol.name} shows strings on a conventional display, which takes its time; "
            f"leave out {setting('fast')}"
        )


def check_live(protocol: Protocol, conditions: Conditions, *, usual: bool) -> None:
    """Check that there is a host process whose memory a live view can show.

    Parameters
    ----------
    protocol, conditions
        What the session shows, and what it is run with.
    usual
        Whether the engine is the usual one.

    Raises
    ------
    InputError
        If there is none.
    """
    name = setting("monitor")
    if protocol.medium == "paper":
        raise InputError(
            f"{protocol.name} is read on paper, and {name} shows a device; leave it out"
        )
    if conditions.fast:
        raise InputError(
            f"{name} is for sessions that run by the clock; leave it out, or {setting('fast')}"
        )
    if not usual:
        raise InputError(f"{name} is for the usual engine; leave it out with one of your own")
