"""Stochastic gradient descent with momentum, and the search of the learning rate."""

import copy

import torch


def learn(task, labels, ids, rate, epochs, batch, momentum):
    """A copy of task.model trained on the touches `ids`, in evaluation mode; the task's own model stays as it was.

    task: one of stages.transfer.MODES; labels (k,) i8 of all touches; ids (n,) i8. Minimises the cross-entropy of a
    softmax; the touches are shuffled at every epoch, and an odd rest below a batch waits for the next (T5.3).
    """
    model = copy.deepcopy(task.model)
    optimiser = torch.optim.SGD([p for p in model.parameters() if p.requires_grad], lr=rate, momentum=momentum)
    labels, ids = torch.as_tensor(labels), torch.as_tensor(ids)
    batch = min(batch, len(ids))
    model.train()
    for _ in range(epochs):
        shuffled = ids[torch.randperm(len(ids))]
        for start in range(0, len(ids) - batch + 1, batch):
            chosen = shuffled[start : start + batch]
            loss = torch.nn.functional.cross_entropy(model(task.training_inputs(chosen)), labels[chosen])
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
    model.eval()
    task.finish(model, ids)
    return model


@torch.no_grad()
def scores(model, task, ids, batch=64):
    """(n, classes) f4: the softmax of the model for the touches `ids`, not augmented."""
    parts = torch.as_tensor(ids).split(batch)
    return torch.cat([model(task.inputs(part)).softmax(dim=1) for part in parts])


def accuracy(found, labels):
    """Share of touches whose highest score is that of their class; scores that are not finite count as wrong."""
    right = found.argmax(dim=1) == torch.as_tensor(labels)
    return float((right & found.isfinite().all(dim=1)).float().mean())


def search(task, labels, part, validation, rates, **training):
    """(rate, accuracy on the validation part): the best of the learning rates, the first of equals.

    The networks tried see the training part without its validation touches, and never a test touch.
    """
    tried = []
    for rate in rates:
        model = learn(task, labels, part, rate, **training)
        tried.append((accuracy(scores(model, task, validation), labels[validation]), rate))
    best = max(tried, key=lambda pair: pair[0])
    return best[1], best[0]
