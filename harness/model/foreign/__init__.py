"""Methods in any language: programs that read a wall and write a result, run and judged as any other method."""
