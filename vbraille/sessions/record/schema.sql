-- Tables of a session's file; docs/session-format.md says what each column holds.
CREATE TABLE session (          -- one row: who, what, and all that does not change
    id INTEGER PRIMARY KEY CHECK (id = 1), format INTEGER NOT NULL, participant TEXT NOT NULL,
    protocol TEXT NOT NULL, seed INTEGER NOT NULL, head TEXT NOT NULL CHECK (json_valid(head))
) STRICT;
CREATE TABLE file (             -- the protocol and what stands beside it, byte for byte
    name TEXT PRIMARY KEY, content BLOB NOT NULL
) STRICT;
CREATE TABLE trial (            -- the plan
    practice INTEGER NOT NULL, number INTEGER NOT NULL, block INTEGER NOT NULL,
    condition TEXT NOT NULL, item TEXT NOT NULL, gap_s REAL NOT NULL, catch TEXT NOT NULL,
    columns TEXT NOT NULL CHECK (json_valid(columns)),
    stimuli TEXT NOT NULL CHECK (json_valid(stimuli)), PRIMARY KEY (practice, number)
) STRICT;
CREATE TABLE event (            -- what happened, in order
    n INTEGER PRIMARY KEY, kind TEXT NOT NULL, t_s REAL NOT NULL, wall TEXT NOT NULL,
    practice INTEGER, trial INTEGER, attempt INTEGER,
    data TEXT NOT NULL CHECK (json_valid(data)), sum BLOB NOT NULL
) STRICT;
CREATE TABLE ticks (            -- a second or less of the device's ticks; see `read_ticks`
    after INTEGER NOT NULL REFERENCES event (n), first INTEGER NOT NULL, count INTEGER NOT NULL,
    first_line INTEGER NOT NULL, last_line INTEGER NOT NULL, fields BLOB NOT NULL,
    sum BLOB NOT NULL, PRIMARY KEY (after, first)
) STRICT;
CREATE TABLE seal (             -- the newest sum when a console closed the file last
    id INTEGER PRIMARY KEY CHECK (id = 1), sum BLOB NOT NULL
) STRICT;
CREATE INDEX ticks_of_line ON ticks (first_line);
CREATE INDEX event_of_trial ON event (trial, practice, kind);
CREATE TRIGGER events_do_not_change BEFORE UPDATE ON event
    BEGIN SELECT RAISE(ABORT, 'events do not change'); END;
CREATE TRIGGER events_do_not_go BEFORE DELETE ON event
    BEGIN SELECT RAISE(ABORT, 'events do not go'); END;
CREATE VIEW answers AS          -- the answer of each trial that counts
    SELECT t.practice, t.number AS trial, t.block, t.condition, t.catch, t.item, e.attempt,
        json_extract(e.data, '$.answer') AS answer, e.t_s, e.wall
    FROM trial t LEFT JOIN event e ON e.kind = 'answer' AND e.n = (
        SELECT max(n) FROM event
        WHERE trial = t.number AND practice = t.practice AND kind IN ('answer', 'undo', 'missed'));
