"""Sessions in, tables and figures out. Sees no device and no engine.

`study` reads sessions (`sittings`, `reading`) and tables (`sheets`, `parsing`, `values`) into
`trials`. A module a question makes `tables` of them: `legibility`, `characters`, `confusion`,
`errors`, `overtime`, `motion`, `levels` and `tuning`; `figures` says what to draw. `analyse` puts
all together as `results`, which `report` writes. `statistics` knows nothing but plain numbers.
"""
