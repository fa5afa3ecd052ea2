/** State that others listen to. */
report.store = (() => {
  /** A store; listeners get the names of what changed. */
  function create(initial) {
    const state = { ...initial };
    const listeners = [];
    return {
      state,
      listen(names, listener) {
        listeners.push([names, listener]);
      },
      set(changes) {
        const changed = Object.keys(changes).filter((name) => !equal(state[name], changes[name]));
        changed.forEach((name) => {
          state[name] = changes[name];
        });
        if (changed.length > 0) {
          listeners
            .filter(([names]) => names === null || names.some((name) => changed.includes(name)))
            .forEach(([, listener]) => listener(changed));
        }
      },
    };
  }

  function equal(one, other) {
    return (
      one === other || (typeof one === "object" && JSON.stringify(one) === JSON.stringify(other))
    );
  }

  return { create };
})();
