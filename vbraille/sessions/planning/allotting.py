"""Which group and which order of conditions a participant has."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.planning.chance import balanced_orders
from vbraille.toml.tomlfile import which
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.sessions.planning.protocol import Protocol


def choose_group(protocol: Protocol, participant: str, group: str | None) -> str:
    """Name of the participant's group; empty if the protocol has no groups.

    Parameters
    ----------
    protocol, participant
        The protocol, and the participant's pseudonym, whose last number chooses the group if
        nothing else does.
    group
        Group that was asked for; None for that of the table of orders, or of the number.

    Raises
    ------
    InputError
        If there is no such group, the table gives another, or there is nothing to go by.
    """
    groups = protocol.groups
    if group is None and protocol.group:
        return protocol.group
    if not groups:
        if group:
            raise InputError(f"{protocol.name} has no groups; leave {setting('group')} out")
        return ""
    if group is not None and group not in groups:
        raise InputError(f"there is no group {group!r}{which(group, groups)}")
    told = next((row.group for row in protocol.order_rows if row.participant == participant), None)
    if told is not None:
        if group not in (None, told):
            raise InputError(
                f"the table of orders has {participant} in the group {told}; leave "
                f"{setting('group')} out"
            )
        return told
    if group is not None:
        return group
    return groups[(_number(participant, "group", "NAME") - 1) % len(groups)]


def choose_order(protocol: Protocol, participant: str, order: int | None) -> int:
    """Number of the balanced order or row of the table, from 1; 0 if there is only one order.

    Raises
    ------
    InputError
        If an order is asked for that there is not, or there is nothing to go by.
    """
    if protocol.order_rows:
        return _row(protocol, participant, order)
    if not protocol.balanced:
        if order is not None:
            raise InputError(
                f"{protocol.name} has no balanced orders; leave {setting('order')} out"
            )
        return 0
    if order is None:
        number = _number(participant, "order", "N")
        # Groups take turns, so that each of them has all orders.
        order = (number - 1) // max(1, len(protocol.groups)) + 1
    elif order < 1:
        raise InputError(f"order is {order}; it must be 1 or more")
    return (order - 1) % len(balanced_orders(len(protocol.conditions))) + 1


def _row(protocol: Protocol, participant: str, order: int | None) -> int:
    rows = protocol.order_rows
    if order is not None:
        if not 1 <= order <= len(rows):
            raise InputError(f"order is {order}; it must be 1 to {len(rows)}, a row of the table")
        return order
    names = [row.participant for row in rows]
    if participant not in names:
        raise InputError(
            f"the table of orders of {protocol.name} has no participant "
            f"{participant!r}{which(participant, names)}; or give {setting('order')} N, a row"
        )
    return names.index(participant) + 1


def _number(participant: str, what: str, give: str) -> int:
    """Last number in a pseudonym, by which the group or the order goes."""
    numbers = re.findall("[0-9]+", participant)
    if not numbers:
        whose = "order of the conditions" if what == "order" else "group"
        raise InputError(
            f"the {whose} goes by the participant's number, and {participant} "
            f"has none; give {setting(what)} {give}, or a participant such as P07"
        )
    return int(numbers[-1])
